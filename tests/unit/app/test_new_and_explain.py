#!/usr/bin/env python3
"""The verbs new and explain: test_new_and_explain.py MULDI_SIM."""

import math
import unittest

from program import ProgramTest, options, values

KINDS = ("joint", "muscle", "trunk", "solid", "optimal")
SHORT = {"joint": "dynamics.duration=10", "muscle": "dynamics.duration=1", "trunk": "dynamics.duration=10", "solid": "dynamics.duration=0.1"}


class New(ProgramTest):
    def test_writes_scenes_that_run(self):
        for kind in KINDS:
            self.program("new", kind, "-o", f"{kind}.yaml")
            self.assertEqual(self.program("new", kind).stdout, (self.folder / f"{kind}.yaml").read_text())
            self.program("validate", f"{kind}.yaml")
            if kind == "optimal":
                continue
            output = self.run_scene(self.folder / f"{kind}.yaml", f"{kind}.h5", *options([SHORT[kind]]))
            self.assertGreaterEqual(len(values(output, "time")), 2)

    def test_shows_optimal_control_with_limits_stages_and_a_replay(self):
        self.program("new", "optimal", "-o", "a.yaml")
        said = self.program("optimise", "a.yaml").stdout
        self.assertIn("stage 1 of 2, feasibility: optimal after", said)
        self.assertIn("stage 2 of 2, effort: optimal after", said)
        self.assertIn("  at its upper bound: limits.true_field of muscles/upper, 15\n", said)
        self.assertIn("\nreplay less optimum ", said)
        degrees = 180 / math.pi
        self.assertAlmostEqual(values(self.folder / "a.h5", "joints/hinge/coordinate")[-1, 0] * degrees, 7, delta=1e-6)
        # Held afterwards by the field whose equilibrium is 7 degrees to two digits.
        self.assertEqual(values(self.folder / "a.h5", "replay/time")[-1], 500.0)
        self.assertAlmostEqual(values(self.folder / "a.h5", "replay/joints/hinge/coordinate")[-1, 0] * degrees, 7, delta=0.05)

    def test_begins_with_a_joint_and_overwrites_only_when_told(self):
        self.assertEqual(self.program("new").stdout, self.program("new", "joint").stdout)
        self.program("new", "-o", "a.yaml")
        self.assertEqual(self.message("new", "-o", "a.yaml", code=2), "error: 'a.yaml' exists; give --force to overwrite it")
        self.program("new", "muscle", "-o", "a.yaml", "--force")
        self.assertIn("title: Free actuator", (self.folder / "a.yaml").read_text())

    def test_tells_the_kinds(self):
        self.assertEqual(self.message("new", "gripper", code=2), "error: no starter scene 'gripper'; known: joint, muscle, trunk, solid, optimal")
        self.assertIn("joint: a hinged bar between two antagonistic muscles;", " ".join(self.program("new", "--help").stdout.split()))


class Explain(ProgramTest):
    def test_prints_what_the_reader_knows(self):
        text = self.program("explain", "materials.silicone.elastic.poisson").stdout
        self.assertEqual(
            text,
            "materials.<name>.elastic.poisson\n  Poisson's ratio; 0.5 is incompressible\n  kind     number\n  range    > -1 and <= 0.5\n  needed   no\n",
        )
        self.assertIn("  revolute     one rotation about an axis; coordinate: angle\n", self.program("explain", "joints.*.type").stdout)
        self.assertRegex(self.program("explain").stdout, r"\n  bodies +rigid bodies by name\n")

    def test_refuses_unknown_paths(self):
        self.assertEqual(
            self.message("explain", "muscles.upper.sektion", code=2), "error: muscles.<name>: no key 'sektion' (did you mean 'section'?)"
        )


if __name__ == "__main__":
    unittest.main()
