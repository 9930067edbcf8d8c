#!/usr/bin/env python3
"""What a scene does not hold does not exist: test_skipped.py MULDI_SIM. Times and memory: tests/bench/SKIPPED.md."""

import re
import unittest

import h5py

from program import SCENES, ProgramTest, data_sets, options

VISCOUS_LINE = re.compile(r"^ *viscous:.*\n", re.MULTILINE)

BARE = """\
muldi: 1
gravity: [0, -9.81e-3, 0]
bodies: {arm: {mass: 40, inertia: [1.0e+5, 3.17e+5, 3.17e+5], position: [46, 0, 0], points: {pivot: [-46, 0, 0]}}}
joints: {hinge: {type: revolute, from: {body: ground, at: [0, 0, 0]}, to: {body: arm, at: pivot}, axis: [0, 0, 1]}}
dynamics: {duration: 10, step: 1}
"""


class Assembled(ProgramTest):
    """`validate` counts from the built model."""

    def summary(self, scene, *overrides):
        path = SCENES / f"{scene}.yaml" if isinstance(scene, str) else scene
        return self.program("validate", path, *options(overrides)).stdout

    def without_viscosity(self, scene):
        text, n = VISCOUS_LINE.subn("", (SCENES / f"{scene}.yaml").read_text())
        self.assertEqual(n, 1)
        return self.write(f"{scene}.yaml", text)

    def test_no_viscous_term_without_viscosity(self):
        for scene in ("cube", "revolute_joint_lumped"):
            with self.subTest(scene):
                self.assertIn("damping yes", self.summary(scene))
                self.assertIn("damping no", self.summary(self.without_viscosity(scene)))
        self.assertIn("viscous terms no, mass yes\n", self.summary(self.without_viscosity("cube")))

    def test_no_unknown_potential_without_a_dielectric_or_where_all_are_prescribed(self):
        self.assertIn("unknown potentials 612,", self.summary("cube"))
        panel = self.summary("cook_membrane")
        self.assertIn("electric no", panel)
        self.assertIn("no potentials (none is prescribed)", panel)
        self.assertIn("no unknown potentials (all are prescribed)", self.summary("membrane_fe"))

    def test_no_pressure_in_plain_displacements(self):
        self.assertIn("element pressures 512\n", self.summary("boxed_cube_II"))
        self.assertIn("element pressures no\n", self.summary("boxed_cube_I"))

    def test_no_mesh_in_a_lumped_scene(self):
        lumped = ("muscles.upper.model=lumped", "muscles.lower.model=lumped")
        self.assertRegex(self.summary("revolute_joint_twin"), r"finite elements yes\n  muscle upper: 216 nodes")
        summary = self.summary("revolute_joint_twin", *lumped)
        self.assertIn("finite elements no", summary)
        self.assertNotRegex(summary, r"nodes|cells|solver solid|factors")


class Computed(ProgramTest):
    def same_bits(self, scene, *overrides):
        """The statics do not see the overrides."""
        first = data_sets(self.run_scene(scene, "a.h5", "--force"))
        second = data_sets(self.run_scene(scene, "b.h5", "--force", *options(overrides)))
        self.assertTrue(any(name.startswith("statics/") for name in first))
        self.assertEqual(first, second)

    def test_no_mass_and_no_viscosity_in_statics(self):
        self.same_bits("cook_membrane.yaml", "materials.rubber.density=1000 g/cm^3")
        viscous = "materials.silicone.viscous={model: kelvin_voigt, viscosity: 10}"
        self.same_bits("pull_in.yaml", "materials.silicone.density=1000 g/cm^3", viscous)


class Loaded(ProgramTest):
    def test_no_page_of_the_optimiser_while_finite_elements_run(self):
        output = self.folder / "a.h5"
        overrides = ["dynamics.duration=1000 ms", "record.every=1", "solids.cube.mesh.box.cells=[2, 2, 2]"]
        process = self.start("run", SCENES / "cube.yaml", "-o", output, *options(overrides))
        self.open_live(output, process).close()
        with open(f"/proc/{process.pid}/maps", encoding="utf-8") as file:
            maps = file.read()
        self.assertIn("muldi-sim", maps)
        self.assertNotRegex(maps, r"lib(muldi_ipopt|ipopt|coin|d?mumps)")
        self.assertEqual(self.interrupt(process, output, 0), 130)

    def test_no_unit_system_without_a_text_with_a_unit(self):
        said = "a text with a unit: making the unit system"
        bare = self.write("bare.yaml", BARE)
        self.assertNotIn(said, self.program("-vv", "run", bare, "-o", "a.h5").stderr)
        self.assertIn(said, self.program("-vv", "run", bare, "-o", "b.h5", "--set", "dynamics.duration=10 ms").stderr)


class Recorded(ProgramTest):
    def groups(self, scene, *overrides):
        with h5py.File(self.run_scene(scene, "a.h5", "--force", *options(overrides)), "r") as file:
            return set(file)

    def test_no_group_of_bodies_and_muscles_beside_a_solid(self):
        found = self.groups("cube.yaml", "dynamics.duration=0.01 ms", "solids.cube.mesh.box.cells=[2, 2, 2]")
        self.assertEqual(found, {"checkpoint", "controls", "electrodes", "energy", "momentum", "probes", "solver", "time"})

    def test_no_field_that_nobody_asked_for(self):
        short = ("dynamics.duration=0.01 ms", "solids.cube.mesh.box.cells=[2, 2, 2]")
        self.assertNotIn("solids", self.groups("cube.yaml", *short))
        self.assertIn("solids", self.groups("cube.yaml", *short, "record.fields={cube: [position]}"))


if __name__ == "__main__":
    unittest.main()
