#!/usr/bin/env python3
"""Runs of four kinds, 200 of them killed at random moments: files open, no row that a reader saw is lost, and the runs go on to the
same bits: test_killed_runs.py MULDI_SIM."""

import pathlib
import random
import signal
import sys
import time
import unittest

import h5py

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "unit" / "app"))
from program import SCENES, ProgramTest, options

KILLS = 50  # of each kind
MOST_ATTEMPTS = 400  # kills that come too late prove nothing and cost no more than their time


class KilledRuns(ProgramTest):
    def rows(self, output):
        """Rows that a reader finds, every one of them whole; 0 where the file does not open yet, or is empty."""
        try:
            with h5py.File(output, "r", swmr=True) as file:
                count = file["time"].shape[0]
                times = list(file["time"][:])
                self.assertEqual(times, sorted(set(times)))
                return count
        except (OSError, KeyError):
            return 0

    def look(self, output, seen):
        """What a kill has left: True if there is something to go on from."""
        if not any(output.read_bytes()[:8]):
            self.assertEqual(seen, 0)
            self.assertIn("it is empty", self.message("info", output, code=2))
            return False
        self.program("info", output)
        with h5py.File(output, "r") as file:
            self.assertIn(file.attrs["status"], ("running", "completed"))
        self.assertGreaterEqual(self.rows(output), seen)
        return True

    def kill_often(self, scene, *overrides):
        arguments = [SCENES / f"{scene}.yaml", *options(overrides)]
        begin = time.monotonic()
        self.program("run", *arguments, "-o", "whole.h5")
        duration = time.monotonic() - begin
        output = self.folder / "a.h5"
        generator = random.Random(scene)
        kills, with_rows = 0, 0
        for _ in range(MOST_ATTEMPTS):
            process = self.start("run", *arguments, "-o", output)
            self.wait_for(output.exists, process, f"{output} exists")
            time.sleep(generator.uniform(0.0, duration))
            seen = self.rows(output)
            process.send_signal(signal.SIGKILL)
            if process.wait() == -signal.SIGKILL:
                kills += 1
                with_rows += seen > 0
                goes_on = self.look(output, seen)
                self.program("run", *arguments, *(["--resume", output] if goes_on else ["-o", output, "--force"]))
            self.assert_same_bits("whole.h5", output)
            output.unlink()
            if kills == KILLS:
                break
        self.assertEqual(kills, KILLS)
        self.assertGreaterEqual(with_rows, 1, "kills came while there were rows")
        print(f"{scene}: {kills} kills, {with_rows} of them with rows; a whole run takes {duration:.2f} s", file=sys.stderr)

    def test_bodies(self):
        self.kill_often("tree", "dynamics.duration=8 s", "record.every=2")

    def test_lumped_muscles(self):
        self.kill_often("elephant_trunk_lumped", "record.every=5")

    def test_a_solid(self):
        self.kill_often("cube", "record.every=2", "dynamics.duration=0.4 ms")

    def test_finite_element_muscles_on_bodies(self):
        self.kill_often("revolute_joint_fe", "dynamics.duration=1500 ms", "record.every=1")


if __name__ == "__main__":
    unittest.main()
