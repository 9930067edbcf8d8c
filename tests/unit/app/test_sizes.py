#!/usr/bin/env python3
"""What is too large is refused with a sentence before it is built: test_sizes.py MULDI_SIM."""

import resource
import unittest

from program import SCENES, ProgramTest, options


class Refused(ProgramTest):
    """By validate and by run alike, exit code 2, no file."""

    def refused(self, scene, expression, *overrides):
        for verb in (["validate", scene], ["run", scene, "-o", "a.h5"]):
            self.assertRegex(self.message(*verb, *options(overrides), code=2).splitlines()[-1], expression)
        self.assertFalse((self.folder / "a.h5").exists())

    def bodies(self, count):
        lines = [f"  b{i}: {{mass: 1, inertia: [1, 1, 1], position: [{i}, 0, 0]}}\n" for i in range(count)]
        return self.write("many.yaml", "muldi: 1\nbodies:\n" + "".join(lines) + "dynamics: {duration: 1 s, step: 1 ms}\n")

    def test_a_million_bodies(self):
        scene = self.bodies(1_000_000)
        size = scene.stat().st_size
        self.refused(scene, rf"^.*many\.yaml: error: cannot read: it has {size} bytes, at most 16777216 are read$")

    def test_dense_statics_beyond_the_memory(self):
        # 4 dense matrices of 6 x 20000 velocities.
        expression = r"^error: a system of 20000 bodies, whose statics solve with a dense matrix, takes 429 GiB, more than the [\d.]+ GiB of this "
        self.refused(self.bodies(20_000), expression + "machine: take fewer bodies, or dynamics alone$", "statics.steps=3")

    def test_a_billion_cells(self):
        expression = r"cube\.yaml:\d+:11: error: solids\.cube\.mesh: makes 1e\+09 cells, at most 2e\+07 are built$"
        self.refused(SCENES / "cube.yaml", expression, "solids.cube.mesh.box.cells=[1000, 1000, 1000]")

    def test_a_step_of_a_femtosecond_over_days(self):
        expression = r"^--set dynamics\.step=1e-12 s: error: dynamics\.step: gives 1e\+18 steps, at most 2e9 are run$"
        self.refused(SCENES / "pendulum.yaml", expression, "dynamics.duration=1e6 s", "dynamics.step=1e-12 s")

    def test_results_beyond_the_disk(self):
        # 2e9 rows of the trunk's hundreds of numbers: some 10 TiB.
        expression = (
            r"^error: the results take [\d.e+]+ GiB, more than the [\d.e+]+ GiB of the whole disk: record fewer rows \(record\.every\) or "
            r"quantities \(record\.quantities\), or take a longer step or a shorter duration$"
        )
        self.refused(SCENES / "elephant_trunk_lumped.yaml", expression, "dynamics.duration=1.9 s", "dynamics.step=1 ns")


class OutOfMemory(ProgramTest):
    """A limit of the address space (ulimit -v) is the memory of the machine; what it cannot foresee ends with a sentence too."""

    def within(self, mebi):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (mebi << 20, mebi << 20))

        arguments = ["run", SCENES / "cube.yaml", "-o", "a.h5", "--force", *options(["solids.cube.mesh.box.cells=[30, 30, 30]"])]
        # 2 where it is foreseen, else 4.
        for code in (2, 4):
            try:
                return self.program(*arguments, code=code, preexec_fn=limit).stderr.strip().splitlines()[-1]
            except AssertionError:
                if code == 4:
                    raise
        return None

    def test_is_foreseen(self):
        self.assertRegex(self.within(98), r"error: solids\.cube: a mesh of 27000 cells takes [\d.]+ GiB, more than the 0\.0957 GiB of this machine: take fewer cells$")

    def test_is_told(self):
        self.assertEqual(self.within(360), "error: out of memory: `muldi-sim validate` estimates what a scene takes; take fewer cells or bodies")


if __name__ == "__main__":
    unittest.main()
