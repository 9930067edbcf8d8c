#!/usr/bin/env python3
"""A sweep of 200 joints killed at random, whole and in shards, ends with the bytes of the unbroken one: test_killed_sweeps.py MULDI_SIM."""

import pathlib
import random
import signal
import sys
import time
import unittest

import h5py

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "unit" / "app"))
from program import SCENES, ProgramTest, data_sets

STUDY = f"""sweep: 1
scene: {SCENES / 'revolute_joint_lumped.yaml'}
vary:
  controls.agonist.field: {{linspace: [0, 60 kV/mm, 20]}}
  materials.silicone.viscous.viscosity: {{logspace: [1, 50, 10]}}
outputs:
  angle: "joints.hinge.coordinate[-1]"
  overshoot: "max(joints.hinge.coordinate)"
"""


class KilledSweeps(ProgramTest):
    def setUp(self):
        super().setUp()
        self.study = self.write("study.yaml", STUDY)
        self.program("sweep", self.study, "-o", "whole.h5", "--jobs", 2, code=3)  # the strongest fields find no equilibrium

    def assert_same(self, stem):
        self.assertEqual((self.folder / "whole.csv").read_bytes(), (self.folder / f"{stem}.csv").read_bytes())
        self.assertEqual(data_sets(self.folder / "whole.h5"), data_sets(self.folder / f"{stem}.h5"))

    def finished(self, journal):
        """The whole lines of a journal: what no kill may take away."""
        if not journal.exists():
            return []
        return journal.read_bytes().split(b"\n")[1:-1]

    def look(self, stem, kept):
        """What a killed sweep has left can be read, and merged into a table that has every finished point."""
        for name in (f"{stem}.h5", "whole.h5"):
            if (self.folder / name).exists():
                data_sets(self.folder / name)
        begun = (self.folder / f"{stem}.journal").exists() and b"\n" in (self.folder / f"{stem}.journal").read_bytes()
        done = self.program("sweep", self.study, "-o", f"{stem}.h5", "--merge", code=3 if begun else 2)
        if not begun:
            self.assertIn("error: nothing to merge: no part of this sweep has begun beside", done.stderr)
            return
        with h5py.File(self.folder / f"{stem}.h5", "r") as table:
            words = table["status"].attrs["words"].split("\n")
            missing = [words[number] for number in table["status"]].count("missing")
            self.assertEqual(len(table["status"]), 200)
        rows = (self.folder / f"{stem}.csv").read_text().splitlines()[1:]
        self.assertEqual(sum("missing" in row for row in rows), missing)
        self.assertEqual(missing, 200 - kept)

    def kill_again_and_again(self, arguments, journal, generator, delays):
        """Kills at random moments; returns how many came in time. No finished point is ever lost."""
        kills = 0
        for most in delays:
            process = self.start("sweep", self.study, *arguments)
            time.sleep(generator.uniform(0.0, most))
            before = self.finished(journal)
            process.kill()
            self.assertIn(process.wait(), (3, -signal.SIGKILL), self.said()[-1000:])
            kills += process.returncode == -signal.SIGKILL
            self.assertEqual(self.finished(journal)[: len(before)], before)
        return kills

    def test_whole(self):
        """200 kills; a sweep that was finished in spite of them is compared and begun again."""
        generator = random.Random(1)
        journal = self.folder / "broken.journal"
        kills, ends = 0, 0
        while kills < 200:
            one = self.kill_again_and_again(["-o", "broken.h5", "--jobs", 2], journal, generator, [0.4])
            kills += one
            if one:
                self.look("broken", len(self.finished(journal)))
            else:
                self.assert_same("broken")
                ends += 1
                for name in ("broken.h5", "broken.csv", "broken.journal"):
                    (self.folder / name).unlink()
        self.program("sweep", self.study, "-o", "broken.h5", "--jobs", 2, code=3)
        self.assert_same("broken")
        print(f"{kills} kills, {ends + 1} sweeps finished")

    def test_in_shards(self):
        generator = random.Random(2)
        for k in (1, 2, 3):
            shard = ["-o", "parts.h5", "--shard", f"{k}/3"]
            self.kill_again_and_again(shard, self.folder / f"parts.journal.{k}-of-3", generator, 4 * [0.5])
            self.program("sweep", self.study, *shard, code=3)
        self.assert_same("parts")


if __name__ == "__main__":
    unittest.main()
