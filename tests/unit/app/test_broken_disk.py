#!/usr/bin/env python3
"""A run that is killed, or whose disk is full, at each of its changes of the result file: test_broken_disk.py MULDI_SIM BROKEN_DISK [--all].

Without --all a part of the changes: the first and the last, which make the file and bring it to its end, and some between.
"""

import os
import pathlib
import random
import signal
import subprocess
import sys
import unittest

import h5py

DISK = str(pathlib.Path(sys.argv.pop(2)).resolve())
ALL = "--all" in sys.argv and not sys.argv.remove("--all")

from program import PROGRAM, SCENES, TIME_LIMIT, ProgramTest, data_sets, options  # noqa: E402: takes its argument likewise

# Three blocks of rows in a few milliseconds.
RUN = [SCENES / "pendulum.yaml", "--no-paraview", *options(["dynamics.duration=12 s", "dynamics.step=5 ms"])]


class Broken(ProgramTest):
    def broken(self, what, *arguments):
        """Runs it on a broken disk; returns exit code and words."""
        # Where the program is built with the address sanitizer that is no longer the first library.
        environment = os.environ | {"LD_PRELOAD": DISK, "BROKEN_DISK": what, "ASAN_OPTIONS": "verify_asan_link_order=0"}
        command = [str(PROGRAM), *map(str, arguments)]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=TIME_LIMIT, check=False, env=environment)
        return done.returncode, done.stderr.strip()

    def changes(self, *arguments):
        """How often an undisturbed run changes the file."""
        self.assertEqual(self.broken(f"count:{self.folder / 'count.txt'}", *arguments)[0], 0)
        return int((self.folder / "count.txt").read_text())

    def look(self, output, whole, statuses):
        """The file opens in every way and has the first rows of the whole one; returns its number of rows."""
        if not any(output.read_bytes()[:8]):
            sentence = f"error: cannot read '{output.name}': it is empty: no result, or its run was killed before its start was recorded"
            self.assertEqual(self.message("info", output.name, code=2), sentence)
            self.assertEqual(self.message("run", *RUN, "--resume", output.name, code=2), sentence)
            return None
        self.program("info", output.name)
        rows = set()
        for how in ({}, {"swmr": True}):
            with h5py.File(output, "r", **how) as file:
                self.assertIn(file.attrs["status"], statuses)
                self.assertEqual(len(file.attrs["git_hash"]) > 0, True)
                n = file["time"].shape[0]
                for name, (shape, _, content) in whole.items():
                    values = file[name][()]
                    if len(shape) == 0 or shape[0] == whole["time"][0][0]:
                        self.assertGreaterEqual(values.shape[0], n, name)
                        self.assertTrue(content.startswith(values[:n].tobytes()), name)
                    else:
                        self.assertEqual(values.tobytes(), content, name)
                rows.add(n)
        self.assertEqual(len(rows), 1)
        return rows.pop()

    def some(self, count, ends=8, between=3):
        """The numbers of the changes to look at."""
        if ALL:
            return range(1, count + 1)
        return sorted({*range(1, ends), *range(ends, count - ends, count // between), *range(count - ends, count + 1)})

    def assert_whole(self, output, whole):
        self.assertEqual(data_sets(output), whole)

    def setUp(self):
        super().setUp()
        self.program("run", *RUN, "-o", "whole.h5")
        self.whole = data_sets(self.folder / "whole.h5")
        self.output = self.folder / "a.h5"

    def finish(self, rows):
        """Goes on with the file, or starts anew where there is nothing to go on from."""
        self.program("run", *RUN, *(["-o", "a.h5", "--force"] if rows is None else ["--resume", "a.h5"]))
        self.assert_whole(self.output, self.whole)


class Killed(Broken):
    def test_at_a_change_leaves_a_file_that_opens_and_goes_on(self):
        count = self.changes("run", *RUN, "-o", "counted.h5")
        for what in ("kill", "torn"):
            most = 0
            for number in self.some(count):
                with self.subTest(what=what, number=number):
                    self.output.unlink(missing_ok=True)
                    self.assertEqual(self.broken(f"{what}:{number}", "run", *RUN, "-o", "a.h5")[0], -signal.SIGKILL)
                    rows = self.look(self.output, self.whole, ("running", "completed"))
                    self.assertGreaterEqual(rows or 0, most, "rows that were shown stay")
                    most = rows or 0
                    self.finish(rows)
            self.assertEqual(most, self.whole["time"][0][0])

    def test_at_a_change_of_the_resumption_keeps_what_was_there(self):
        count = self.changes("run", *RUN, "-o", "counted.h5")
        # With rows that have no checkpoint, and are cut, and without.
        for broken_at in (count // 2, count // 2 + 40):
            self.output.unlink(missing_ok=True)
            self.assertEqual(self.broken(f"kill:{broken_at}", "run", *RUN, "-o", "a.h5")[0], -signal.SIGKILL)
            before = self.output.read_bytes()
            count_resumed = self.changes("run", *RUN, "--resume", "a.h5")
            for number in self.some(count_resumed):
                with self.subTest(broken_at=broken_at, number=number):
                    self.output.write_bytes(before)
                    self.assertEqual(self.broken(f"kill:{number}", "run", *RUN, "--resume", "a.h5")[0], -signal.SIGKILL)
                    rows = self.look(self.output, self.whole, ("running", "completed"))
                    self.assertIsNotNone(rows)
                    self.finish(rows)


@unittest.skipUnless(ALL, "long")
class KilledElsewhere(Broken):
    """100 random changes each: files of meshes, with compressed fields, and of the optimiser, which begins anew."""

    def opens(self):
        if not any(self.output.read_bytes()[:8]):
            return False
        self.program("info", "a.h5")
        for how in ({}, {"swmr": True}):
            with h5py.File(self.output, "r", **how) as file:
                self.assertIn(file.attrs["status"], ("running", "completed"))
                file.visititems(lambda name, item: item[()] if isinstance(item, h5py.Dataset) else None)
        return True

    def killed_anywhere(self, arguments, again):
        self.program(*arguments, "-o", "other.h5")
        whole = data_sets(self.folder / "other.h5")
        count = self.changes(*arguments, "-o", "counted.h5")
        generator = random.Random(3)
        for _ in range(100):
            number = generator.randint(1, count)
            with self.subTest(number=number):
                self.output.unlink(missing_ok=True)
                self.assertEqual(self.broken(f"kill:{number}", *arguments, "-o", "a.h5")[0], -signal.SIGKILL)
                self.program(*arguments, *(again if self.opens() else ["-o", "a.h5", "--force"]))
                self.assert_whole(self.output, whole)

    def test_with_meshes(self):
        self.killed_anywhere(
            ["run", SCENES / "cube.yaml", "--no-paraview", *options(["solids.cube.mesh.box.cells=[2, 2, 2]"])], ["--resume", "a.h5"]
        )

    def test_in_optimise(self):
        self.killed_anywhere(["optimise", SCENES / "double_integrator_optimal.yaml", "--no-paraview"], ["-o", "a.h5", "--force"])


class FullDisk(Broken):
    def check(self, what, number, statuses):
        self.output.unlink(missing_ok=True)
        code, said = self.broken(f"{what}:{number}", "run", *RUN, "-o", "a.h5")
        if code == 0:  # only what comes after the last row and the status: the room is given back
            self.finish(self.look(self.output, self.whole, ("completed",)))
            return "completed"
        self.assertEqual(code, 4, said)
        self.assertRegex(said, r"^error: cannot write 'a.h5'.*: No space left on device$")
        if not self.output.exists():
            return None
        rows = self.look(self.output, self.whole, statuses)
        self.finish(rows)
        return rows

    def test_for_a_moment_leaves_the_rows_written_before_and_says_so(self):
        count = self.changes("run", *RUN, "-o", "counted.h5")
        found = []
        for number in self.some(count):
            with self.subTest(number=number):
                found.append(self.check("once", number, ("write_error",)))
        self.assertIn(None, found, "nothing is left of a file that could not be made")
        self.assertIn(self.whole["time"][0][0], found)

    def test_for_good_leaves_the_rows_written_before(self):
        count = self.changes("run", *RUN, "-o", "counted.h5")
        found = []
        for number in self.some(count):
            with self.subTest(number=number):
                found.append(self.check("full", number, ("running",)))
        self.assertIn(None, found, "nothing is left of a file that could not be made")
        self.assertIn(self.whole["time"][0][0], found)


if __name__ == "__main__":
    unittest.main()
