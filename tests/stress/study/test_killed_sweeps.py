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

    def kill_again_and_again(self, arguments, generator, times):
        kills = 0
        for _ in range(times):
            process = self.start("sweep", self.study, *arguments)
            time.sleep(generator.uniform(0.0, 0.5))
            process.kill()
            kills += process.wait() == -signal.SIGKILL
        return kills

    def test_whole(self):
        kills = self.kill_again_and_again(["-o", "broken.h5", "--jobs", 2], random.Random(1), 25)
        self.assertGreaterEqual(kills, 5)
        self.program("sweep", self.study, "-o", "broken.h5", "--jobs", 2, code=3)
        self.assert_same("broken")

    def test_in_shards(self):
        generator = random.Random(2)
        for k in (1, 2, 3):
            shard = ["-o", "parts.h5", "--shard", f"{k}/3"]
            self.kill_again_and_again(shard, generator, 4)
            self.program("sweep", self.study, *shard, code=3)
        self.assert_same("parts")


if __name__ == "__main__":
    unittest.main()
