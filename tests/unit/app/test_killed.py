#!/usr/bin/env python3
"""Files of running and of killed processes can be read, and the runs go on bit for bit: test_killed.py MULDI_SIM."""

import random
import signal
import subprocess
import sys
import time
import unittest

import h5py

from program import SCENES, BrokenRuns, ProgramTest, data_sets, options

MOST_ATTEMPTS = 200  # a test ends long before, unless signals never come in time


class Killed(BrokenRuns):
    ARGUMENTS = [SCENES / "tree.yaml", *options(["dynamics.duration=8 s", "record.every=2"])]

    def look(self, output):
        """A killed file opens in h5py and says running; returns the number of its rows, None if it is empty."""
        if not any(output.read_bytes()[:8]):
            self.assertIn("it is empty", self.message("info", output, code=2))
            return None
        self.program("info", output)
        counts = []
        for how in ({}, {"swmr": True}):
            with h5py.File(output, "r", **how) as file:
                self.assertIn(file.attrs["status"], ("running", "completed"))
                counts.append(file["time"].shape[0])
                self.assertEqual(list(file["time"][:]), [2.0 * k for k in range(counts[-1])])
        self.assertEqual(counts[0], counts[1])
        return counts[0]

    def whole_run(self):
        """The undisturbed result, and the seconds that it took, which are a scale for delays and nothing else."""
        begin = time.monotonic()
        self.program("run", *self.ARGUMENTS, "-o", "whole.h5")
        return self.folder / "whole.h5", time.monotonic() - begin

    def test_runs_killed_at_random_moments_end_with_the_same_bits(self):
        whole, duration = self.whole_run()
        generator = random.Random(7)
        output = self.folder / "a.h5"
        kills, most = 0, 0
        # Kills that come too late prove nothing and cost no more than their time.
        for _ in range(MOST_ATTEMPTS):
            process = self.start("run", *self.ARGUMENTS, "-o", output)
            if self.interrupt(process, output, generator.uniform(0.0, duration), signal.SIGKILL) == -signal.SIGKILL:
                kills += 1
                rows = self.look(output)
                most = max(most, rows or 0)
                self.program("run", *self.ARGUMENTS, *(["-o", output, "--force"] if rows is None else ["--resume", output]))
            self.assert_same_bits(whole, output)
            output.unlink()
            if kills >= 10 and most >= 1024:
                break
        self.assertGreaterEqual(kills, 10)
        self.assertGreaterEqual(most, 1024, "one came after results had been written")

    def test_a_run_killed_again_and_again_ends_with_the_same_bits(self):
        whole, duration = self.whole_run()
        broken = self.folder / "broken.h5"
        generator = random.Random(8)
        first = self.start("run", *self.ARGUMENTS, "-o", broken)
        self.open_live(broken, first).close()
        first.kill()
        first.wait()
        delays = [generator.uniform(0.0, duration / 3) for _ in range(8)]
        codes = self.run_with_breaks(self.ARGUMENTS, broken, delays, signal.SIGKILL)
        self.assertLessEqual(set(codes), {0, -signal.SIGKILL})
        self.assert_same_bits(whole, broken)

    def test_a_file_that_another_writer_has_left_marked_goes_on(self):
        whole, _ = self.whole_run()
        broken = self.folder / "broken.h5"
        for _ in range(MOST_ATTEMPTS):
            process = self.start("run", *self.ARGUMENTS, "-o", broken, "--force")
            if self.interrupt(process, broken, 0) == 130:
                break
        self.assertEqual(process.returncode, 130)
        # The library itself marks a file that is open for writing.
        opener = "import h5py, os, sys; file = h5py.File(sys.argv[1], 'r+', libver='latest'); os.kill(os.getpid(), 9)"
        opened = subprocess.run([sys.executable, "-c", opener, broken], check=False)
        self.assertEqual(opened.returncode, -signal.SIGKILL)
        message = self.message("info", "broken.h5", code=2)
        self.assertEqual(message, "error: cannot read 'broken.h5': its writer was killed while opening it; --resume mends it if it holds results")
        self.program("run", *self.ARGUMENTS, "--resume", broken)
        self.assert_same_bits(whole, broken)


class Live(ProgramTest):
    def test_a_reader_follows_a_running_file(self):
        output = self.folder / "a.h5"
        process = self.start("run", SCENES / "tree.yaml", "-o", output, *options(["dynamics.duration=1000 s", "record.every=30"]))
        seen = set()
        with self.open_live(output, process) as file:
            self.assertEqual(file.attrs["status"], "running")

            def followed():
                for name in ("time", "bodies/hub/position"):
                    file[name].id.refresh()
                rows = file["time"].shape[0]
                self.assertEqual(list(file["time"][:rows]), [30.0 * k for k in range(rows)])
                self.assertGreaterEqual(file["bodies/hub/position"].shape[0], rows)
                seen.add(rows)
                return len(seen) >= 4

            self.wait_for(followed, process, "rows come in")
        self.assertIsNone(process.poll(), "read while it was running")
        self.assertIn("status         running", self.program("info", output).stdout)
        self.program("compare", output, output, "--only", "time")
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(), 130)
        self.assertGreaterEqual(data_sets(output)["time"][0][0], max(seen))


if __name__ == "__main__":
    unittest.main()
