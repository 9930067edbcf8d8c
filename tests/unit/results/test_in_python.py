#!/usr/bin/env python3
"""What a user sees in h5py: test_in_python.py RECORDING_PROCESS. Files of killed and of finished runs open without h5clear."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py

PROGRAM = sys.argv.pop(1)


class InPython(unittest.TestCase):
    def open_killed(self, **options):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "a.h5")
            # Two full blocks of 1024 rows reach the disk, the others die with the process.
            self.assertEqual(subprocess.run([PROGRAM, "write", path, "3000"], check=False).returncode, -9)
            with h5py.File(path, "r", **options) as file:
                self.check(file)

    def check(self, file):
        self.assertEqual(file.attrs["status"], "running")
        self.assertEqual(file.attrs["title"], "Pendel \u00e4")
        self.assertEqual(file["time"].attrs["unit"], "ms")
        self.assertEqual(list(file["time"]), [0.5 * i for i in range(2048)])
        self.assertEqual(file["bodies/pendulum/orientation"].shape, (2048, 3, 3))
        self.assertEqual(list(file["bodies/pendulum/position"][:, 2]), [-i for i in range(2048)])
        self.assertEqual(list(file["solver/iterations"]), [i % 7 for i in range(2048)])
        newest = file["checkpoint/counter"][:, 0].argmax()
        self.assertEqual(file["checkpoint/step"][newest, 0], 2047 - 1)

    def test_opens_a_killed_file_as_any_file(self):
        self.open_killed()

    def test_opens_a_killed_file_with_swmr(self):
        self.open_killed(swmr=True)


if __name__ == "__main__":
    unittest.main()
