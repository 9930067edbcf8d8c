#!/usr/bin/env python3
"""Files of running and of killed processes can be read, and the runs go on bit for bit: test_killed.py MULDI_SIM."""

import random
import signal
import subprocess
import sys
import unittest

import h5py

from program import SCENES, BrokenRuns, ProgramTest, data_sets, options


class Killed(BrokenRuns):
    ARGUMENTS = [SCENES / "tree.yaml", *options(["dynamics.duration=8 s", "record.every=2"])]

    def look(self, output):
        """A killed file opens in h5py and says running; returns the number of its rows."""
        # As a reader of a running file: a kill may leave rows beyond the end that the header states.
        with h5py.File(output, "r", swmr=True) as file:
            self.assertIn(file.attrs["status"], ("running", "completed"))
            rows = file["time"].shape[0]
            self.assertEqual(list(file["time"][:]), [2.0 * k for k in range(rows)])
            return rows

    def test_20_runs_killed_at_random_moments_end_with_the_same_bits(self):
        whole = self.folder / "whole.h5"
        self.program("run", *self.ARGUMENTS, "-o", whole)
        generator = random.Random(7)
        codes, rows = [], []
        for number in range(20):
            output = self.folder / f"{number}.h5"
            process = self.start("run", *self.ARGUMENTS, "-o", output)
            self.open_live(output, process).close()
            codes.append(self.interrupt(process, output, generator.uniform(0.0, 0.25), signal.SIGKILL))
            if codes[-1] == -signal.SIGKILL:
                self.program("info", output)
                rows.append(self.look(output))
                self.program("run", *self.ARGUMENTS, "--resume", output)
            self.assert_same_bits(whole, output)
            output.unlink()
        self.assertGreaterEqual(codes.count(-signal.SIGKILL), 5, "kills came in time")
        self.assertGreaterEqual(max(rows), 1024, "one came after results had been written")

    def test_a_run_killed_again_and_again_ends_with_the_same_bits(self):
        whole, broken = self.folder / "whole.h5", self.folder / "broken.h5"
        self.program("run", *self.ARGUMENTS, "-o", whole)
        generator = random.Random(8)
        first = self.start("run", *self.ARGUMENTS, "-o", broken)
        self.open_live(broken, first).close()
        first.kill()
        first.wait()
        delays = [generator.uniform(0.0, 0.1) for _ in range(8)]
        codes = self.run_with_breaks(self.ARGUMENTS, broken, delays, signal.SIGKILL)
        self.assertLessEqual(set(codes), {0, -signal.SIGKILL})
        self.assert_same_bits(whole, broken)

    def test_a_run_killed_while_it_opens_its_file_goes_on(self):
        whole, broken = self.folder / "whole.h5", self.folder / "broken.h5"
        self.program("run", *self.ARGUMENTS, "-o", whole)
        process = self.start("run", *self.ARGUMENTS, "-o", broken)
        self.assertEqual(self.interrupt(process, broken, 0), 130)
        # A process that has just opened the file for writing has marked it and not yet removed the mark.
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
