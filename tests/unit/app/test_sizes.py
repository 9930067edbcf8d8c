#!/usr/bin/env python3
"""What is too large is refused with a sentence before it is built: test_sizes.py MULDI_SIM."""

import resource
import subprocess
import unittest

from program import PROGRAM, SCENES, ProgramTest, options


class Refused(ProgramTest):
    """By validate and by run (or optimise) alike, exit code 2, no file."""

    def refused(self, scene, expression, *overrides, verb="run"):
        for verb in (["validate", scene], [verb, scene, "-o", "a.h5"]):
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

    def test_an_optimisation_of_a_billion_steps(self):
        # 2 unknowns a step, 6 blocks of 2 x 2 entries of 16 bytes, 4 times: 1536e9 bytes.
        expression = (
            r"^error: a system of 1 body over 1e\+09 steps of its optimal control takes 1\.43e\+03 GiB, more than the [\d.e+]+ GiB of this "
            r"machine: take fewer bodies, or a longer optimal_control\.step$"
        )
        self.refused(SCENES / "double_integrator_optimal.yaml", expression, "optimal_control.step=1 ns", verb="optimise")

    def test_an_optimisation_of_more_steps_than_can_be_counted(self):
        expression = r"error: optimal_control\.step: gives 1e\+15 steps, at most 2e9 are sought$"
        self.refused(SCENES / "double_integrator_optimal.yaml", expression, "optimal_control.step=1e-15 s", verb="optimise")

    RESULTS_IN_MEMORY = (
        r"^error: a motion with its results in memory takes [\d.e+]+ GiB, more than the [\d.e+]+ GiB of this machine: record fewer rows "
        r"\(record\.every\) or quantities \(record\.quantities\), or take a longer step or a shorter duration$"
    )
    ENDLESS = "set: {dynamics.duration: 1.9 s, dynamics.step: 1 ns, record.every: 1}\n"

    def test_sweeps_of_results_beyond_the_memory(self):
        study = self.write("s.yaml", f"sweep: 1\nscene: {SCENES / 'revolute_joint_lumped.yaml'}\n{self.ENDLESS}"
                           "vary: {controls.agonist.field: [10 kV/mm]}\noutputs: {a: 'max(joints.hinge.coordinate)'}\n")
        self.assertRegex(self.message("sweep", study, code=2), self.RESULTS_IN_MEMORY)

    def test_a_point_of_a_sweep_beyond_the_memory_is_marked(self):
        study = self.write("s.yaml", f"sweep: 1\nscene: {SCENES / 'revolute_joint_lumped.yaml'}\nset: {{dynamics.duration: 1.9 s, record.every: 1}}\n"
                           "vary: {dynamics.step: [1 ms, 1 ns]}\noutputs: {a: 'max(joints.hinge.coordinate)'}\n")
        self.assertIn("wrong_input: error: a motion with its results in memory takes", self.program("sweep", study, code=3).stderr)

    def test_fits_of_motions_beyond_the_memory(self):
        self.write("data.csv", "time in ms,angle in rad\n" + "".join(f"{t},0.1\n" for t in range(5)))
        study = self.write("s.yaml", f"calibrate: 1\nscene: {SCENES / 'revolute_joint_lumped.yaml'}\n{self.ENDLESS}"
                           "fit: {materials.silicone.viscous.viscosity: {min: 1, max: 100}}\n"
                           "reference: data.csv\ncompare: {joints.hinge.coordinate: {column: 2}}\n")
        self.assertRegex(self.message("calibrate", study, code=2), self.RESULTS_IN_MEMORY)


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

    def test_is_told_wherever_it_ends(self):
        """Libraries that do not survive a refused allocation have something kept back for them."""
        arguments = ["run", SCENES / "cube.yaml", "-o", "a.h5", "--force", *options(["solids.cube.mesh.box.cells=[14, 14, 14]", "dynamics.duration=0.003"])]
        told = 0
        for kibi in range(112_000, 124_000, 1_000):
            command = [str(PROGRAM), *map(str, arguments)]
            limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (kibi << 10, kibi << 10))
            done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False, preexec_fn=limit)
            self.assertIn(done.returncode, (0, 4), f"{kibi} KiB\n{done.stderr}")
            told += "error: out of memory: `muldi-sim validate` estimates" in done.stderr
        self.assertGreater(told, 0)

    def test_is_told(self):
        self.assertEqual(self.within(360), "error: out of memory: `muldi-sim validate` estimates what a scene takes; take fewer cells or bodies")


if __name__ == "__main__":
    unittest.main()
