#!/usr/bin/env python3
"""A sweep of 200 joints killed at random, whole and in shards, ends with the bytes of the unbroken one: test_killed_sweeps.py MULDI_SIM."""

import pathlib
import random
import signal
import sys
import time
import unittest

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

    def finished(self, stem):
        """Lines of the journals: one for each finished point and one a head."""
        return sum(path.read_bytes().count(b"\n") for path in self.folder.glob(f"{stem}.journal*"))

    def kill_again_and_again(self, stem, arguments, generator, times):
        """Kills that many runs of the sweep, each once some more points stand in its journal and a moment after; where one comes
        to its end before, it is begun anew."""
        kills, anew = 0, []
        while kills < times:
            goal = self.finished(stem) + generator.randrange(6)
            process = self.start("sweep", self.study, "-o", f"{stem}.h5", *arguments, *anew)
            while self.finished(stem) < goal and process.poll() is None:
                time.sleep(0.001)
            time.sleep(generator.uniform(0.0, 0.01))
            process.kill()
            was_killed = process.wait() == -signal.SIGKILL
            kills += was_killed
            anew = [] if was_killed else ["--force"]
            self.assertIn(process.returncode, (-signal.SIGKILL, 3))

    def test_whole(self):
        self.kill_again_and_again("broken", ["--jobs", 2], random.Random(1), 25)
        self.program("sweep", self.study, "-o", "broken.h5", "--jobs", 2, code=3)
        self.assert_same("broken")

    def test_in_shards(self):
        """Each shard is killed in its first run, and runs to its end in the next."""
        generator = random.Random(2)
        for k in (1, 2, 3):
            shard = ["--shard", f"{k}/3"]
            self.kill_again_and_again("parts", shard, generator, 4)
            self.program("sweep", self.study, "-o", "parts.h5", *shard, code=3)
        self.assert_same("parts")


if __name__ == "__main__":
    unittest.main()
