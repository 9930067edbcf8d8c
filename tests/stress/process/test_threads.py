#!/usr/bin/env python3
"""Runs on several threads: test_threads.py MULDI_SIM. The same bits as on one, in every path of the program that works in parallel:
muscles side by side, assembly and factorisation of solids, iterative solvers, the thread that makes the file, sweeps in processes.

`tools/test --threads` runs this with the thread sanitizer, which ends the program with a code of its own where threads race.
"""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "unit" / "app"))
from program import SCENES, ProgramTest, options


class Threads(ProgramTest):
    def assert_same(self, scene, *overrides, threads=(2, 4)):
        set_options = options(overrides)
        self.run_scene(scene, "one.h5", "--threads", 1, "--force", *set_options)
        for number in threads:
            with self.subTest(scene=scene, threads=number):
                self.run_scene(scene, "more.h5", "--threads", number, "--force", *set_options)
                self.assert_same_bits("one.h5", "more.h5")

    def test_finite_element_muscles_on_bodies(self):
        self.assert_same("revolute_joint_twin.yaml", "statics.steps=1", "dynamics.duration=3 ms", "record.every=1")
        self.assert_same("dea_joint_IV.yaml", "statics.steps=1", "dynamics.duration=1 ms", "record.every=1", threads=(3,))

    def test_solids_by_factors(self):
        for number in ("I", "II", "III", "IV"):
            self.assert_same(f"boxed_cube_{number}.yaml", "statics.steps=1", "dynamics.duration=1 ms", threads=(3,))

    def test_solids_attached_to_one_another(self):
        overrides = ("controls.supply.potential=3 kV", "statics.steps=1", "dynamics={duration: 0.3 ms, step: 0.1 ms}")
        self.assert_same("bimorph.yaml", *overrides, "record.fields={active: [position, stress], passive: [position]}", threads=(3,))

    def test_solids_by_iterations(self):
        overrides = ("solids.cube.mesh.box.cells=[6, 6, 6]", "solver.linear=iterative", "dynamics.duration=0.1 ms", "record.every=1")
        self.assert_same("cube.yaml", *overrides, threads=(3,))

    def test_a_sweep_in_processes(self):
        study = self.write("s.yaml", f"sweep: 1\nscene: {SCENES / 'cube.yaml'}\nset: {{dynamics.duration: 0.02 ms}}\n"
                           "vary: {solids.cube.mesh.box.cells: [[2, 2, 2], [4, 4, 4], [2, 4, 2]]}\noutputs: {energy: \"energy.total[-1]\"}\n")
        self.program("sweep", study, "-o", "one.h5")
        self.program("sweep", study, "-o", "two.h5", "--jobs", 3)
        self.assertEqual((self.folder / "one.csv").read_bytes(), (self.folder / "two.csv").read_bytes())


if __name__ == "__main__":
    unittest.main()
