#!/usr/bin/env python3
"""What a process records of solids, and how it goes on: test_solids.py MULDI_SIM."""

import pathlib
import unittest
import xml.etree.ElementTree

import h5py

from program import BrokenRuns, ProgramTest, attribute, options, values
from xdmf_check import check_side_file

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCENE = """\
muldi: 1
title: Actuator of one cube
materials:
  m:
    density: 1e-3
    elastic: {model: neo_hookean, mu: 0.2, poisson: 0.5}
    electric: {model: ideal_dielectric, relative_permittivity: 3}
    viscous: {model: kelvin_voigt, viscosity: 0.05}
controls: {supply: {potential: {sine: {amplitude: 20 kV, frequency: 0.31}}}}
solids:
  cube:
    mesh: {box: {size: [2, 2, 2], cells: [2, 2, 2], centre: [0, 0, 0]}}
    material: m
    conditions:
      - {where: x-, displacement: [0, ~, ~]}
      - {where: y-, displacement: [~, 0, ~]}
      - {where: z-, displacement: [~, ~, 0]}
    electrodes:
      low: {where: y-, potential: 0}
      middle: {where: {plane: {y: 0}}, charge: 0}
      high: {where: y+, potential: {control: supply}}
dynamics: {duration: 0.1, step: 0.005}
"""
ALL_FIELDS = "[position, velocity, potential, pressure, stress, field, true_field, jacobian]"
RECORD = f"record: {{every: 2, fields: {{cube: {{fields: {ALL_FIELDS}, every: 3}}}}, probes: {{r: {{reaction: cube@y-}}}}}}\n"


class SideFile(BrokenRuns):
    def check(self, path):
        return check_side_file(self, path)

    def test_every_reference_of_the_side_file_exists(self):
        output = self.run_scene(self.write("a.yaml", SCENE + RECORD), "a.h5")
        ((name, times, fields),) = self.check(self.folder / "a.xdmf")
        self.assertEqual(name, "cube")
        self.assertEqual(times, list(values(output, "solids/cube/times")))
        self.assertEqual([round(t, 12) for t in times], [0, 0.03, 0.06, 0.09, 0.1])
        self.assertEqual(
            fields,
            {"velocity": "Node", "potential": "Node", "reference": "Node", "displacement": "Node", "pressure": "Cell", "stress": "Cell", "field": "Cell"}
            | {"true_field": "Cell", "jacobian": "Cell"},
        )

    def test_without_positions_the_mesh_stays_in_its_reference(self):
        self.run_scene(self.write("a.yaml", SCENE + "record: {every: 10, fields: {cube: [jacobian]}}\n"), "a.h5")
        ((_, times, fields),) = self.check(self.folder / "a.xdmf")
        self.assertEqual((len(times), fields), (3, {"jacobian": "Cell"}))

    def test_statics_have_a_side_file_of_their_own_beside_that_of_the_motion(self):
        statics = "statics: {control: supply, from: 0, to: 10 kV, steps: 4}\n"
        self.run_scene(self.write("a.yaml", SCENE + statics + RECORD), "a.h5")
        ((_, loads, fields),) = self.check(self.folder / "a.statics.xdmf")
        self.assertEqual((loads, "velocity" in fields), ([0, 7500, 10000], False))
        self.check(self.folder / "a.xdmf")
        alone = SCENE[: SCENE.index("dynamics:")] + statics + RECORD
        self.run_scene(self.write("b.yaml", alone), "b.h5")
        self.check(self.folder / "b.xdmf")
        self.assertFalse((self.folder / "b.statics.xdmf").exists())

    def test_an_interrupted_run_has_a_side_file(self):
        output = self.folder / "a.h5"
        process = self.start("run", self.write("a.yaml", SCENE + RECORD), "-o", output, *options(["dynamics.duration=1000"]))
        self.assertEqual(self.interrupt(process, output, 0.3), 130)
        ((_, times, _),) = self.check(self.folder / "a.xdmf")
        self.assertEqual(times[-1], attribute(output, "status_time"))

    def test_what_nobody_asked_for_is_not_written(self):
        held = SCENE[: SCENE.index("    electrodes:")] + SCENE[SCENE.index("dynamics:") :]
        output = self.run_scene(self.write("a.yaml", held), "a.h5")
        self.assertEqual(sorted(path.name for path in self.folder.glob("a.*")), ["a.h5", "a.yaml"])
        with h5py.File(output, "r") as file:
            self.assertEqual(sorted(file), ["checkpoint", "controls", "energy", "momentum", "solver", "time"])
            self.assertNotIn("memory", file["checkpoint"])


class GoesOn(BrokenRuns):
    RUNS = {
        "incompressible": [],
        "mean dilatation": ["materials.m.elastic.poisson=0.48"],
        "locking": ["materials.m.elastic.poisson=0.48", "solids.cube.formulation=displacement"],
        "steps of the voltage": ["controls.supply.potential={steps: [[0, 20 kV], [3, 5 kV], [6.5, 18 kV], [12, 0]]}"],
        "accounts of the sources": ["record.electric=[capacitance, stored_energy, supplied_energy]"],
    }

    def test_an_interrupted_run_goes_on_with_the_same_bits(self):
        for name, overrides in self.RUNS.items():
            with self.subTest(name):
                arguments = [self.write("a.yaml", SCENE + RECORD), *options([*overrides, "dynamics.duration=20"])]
                whole, broken = self.folder / "whole.h5", self.folder / "broken.h5"
                self.program("run", *arguments, "-o", whole)
                codes = self.run_with_breaks(arguments, broken, [0.0, 0.07, 0.13, 0.19])
                self.assertGreaterEqual(codes.count(130), 2, "two interrupts came in time")
                self.assert_same_bits(whole, broken)
                self.assertEqual(
                    (self.folder / "whole.xdmf").read_text().replace("whole.h5", "broken.h5"), (self.folder / "broken.xdmf").read_text()
                )
                for path in self.folder.glob("*.h5"):
                    path.unlink()

    def test_the_last_state_of_a_record_starts_another_run(self):
        record = "record: {fields: {cube: [position, velocity]}}\n"
        self.run_scene(self.write("first.yaml", SCENE + record), "first.h5")
        whole = self.run_scene(self.write("whole.yaml", SCENE + record), "whole.h5", *options(["dynamics.duration=0.2"]))
        shifted = SCENE.replace("frequency: 0.31", "frequency: 0.31, phase: 0.19477874452256717")  # 2 pi 0.31 0.1
        later = self.run_scene(self.write("later.yaml", shifted + record + "initial: {from: first.h5}\n"), "later.h5")
        for name in ("position", "velocity"):
            path = f"solids/cube/{name}"
            difference = abs(values(whole, path)[20:] - values(later, path)).max()
            self.assertLess(difference, 1e-5 * abs(values(whole, path)).max(), name)


class MuscleFields(BrokenRuns):
    def test_a_muscle_of_finite_elements_has_fields_as_a_solid_has(self):
        twin = (ROOT / "scenes" / "revolute_joint_twin.yaml").read_text().replace("record: {every: 5}\n", "")
        scene = self.write("twin.yaml", twin + "record: {every: 2, fields: {upper: [position, pressure]}}\n")
        short = options(["dynamics.duration=4 ms", "statics.steps=1"])
        self.program("run", scene, *short, "-o", "fe.h5")
        with h5py.File(self.folder / "fe.h5") as file:
            self.assertEqual(file["solids/upper/position"].shape, (3, 216, 3))
            self.assertEqual(file["solids/upper/pressure"].shape, (3, 92))
            self.assertNotIn("lower", file["solids"])
        grids = xml.etree.ElementTree.parse(self.folder / "fe.xdmf").getroot().findall(".//Grid[@GridType='Collection']")
        self.assertEqual([grid.get("Name") for grid in grids], ["upper", "bodies", "muscles"])
        lumped = options(["muscles.upper.model=lumped", "muscles.lower.model=lumped"])
        said = self.program("run", scene, *short, *lumped, "-o", "lumped.h5").stderr
        self.assertIn("warning: record.fields.upper: muscle 'upper' has no mesh, only those of model fe have", said)


class Validate(ProgramTest):
    def test_tells_what_a_solid_is_made_of(self):
        summary = self.program("validate", self.write("a.yaml", SCENE)).stdout
        self.assertIn(
            "  assembled: gravity no, damping yes, electric yes, finite elements yes\n"
            "  solid cube: 27 nodes, 8 cells, incompressible\n"
            "    free positions 54, unknown potentials 1, element pressures 8\n"
            "    viscous terms yes, mass yes\n"
            "    solver ",
            summary,
        )

    def test_counts_the_trunk_as_the_thesis_does(self):
        trunk = ROOT / "scenes" / "elephant_trunk_fe.yaml"
        summary = self.program("validate", trunk).stdout
        self.assertIn("bodies 6, joints 6, muscles 12 (fe), isolated actuators 0,", summary)
        self.assertIn(
            "  muscle m3: 475 nodes, 288 cells, incompressible\n"
            "    free positions 1275, 150 eliminated by ties to segment1 segment2, no unknown potentials (all are prescribed), "
            "element pressures 288\n",
            summary,
        )
        # Thesis: 3456 cells, 33168 unknowns with potentials and three fields a cell, 1650 eliminated.
        self.assertIn(
            "  all 12 meshes: 5700 nodes, 3456 cells; unknowns 18756 = 15300 positions + 0 potentials + 3456 pressures; "
            "1650 eliminated by ties, 150 prescribed\n"
            "    with all positions, potentials and three fields a cell they would be 33168\n",
            summary,
        )

    def test_tells_what_is_left_out(self):
        prescribed = "displacement: [0, ~, ~], potential: 0"
        statics = SCENE.replace("dynamics: {duration: 0.1, step: 0.005}", "statics: {steps: 2}").replace("    viscous: ", "    # ")
        summary = self.program("validate", self.write("a.yaml", statics)).stdout
        self.assertIn("    viscous terms no, mass no (statics)\n", summary)
        dead = statics[: statics.index("    electrodes:")] + "statics: {steps: 2}\n"
        summary = self.program("validate", self.write("b.yaml", dead)).stdout
        self.assertIn("    free positions 54, no potentials (none is prescribed), element pressures 8\n", summary)
        one = dead.replace("displacement: [0, ~, ~]", prescribed).replace("cells: [2, 2, 2]", "cells: [1, 2, 2]")
        one = one.replace("    conditions:\n", "    formulation: displacement\n    conditions:\n      - {where: x+, potential: 1 kV}\n")
        summary = self.program("validate", self.write("c.yaml", one.replace("poisson: 0.5", "poisson: 0.4"))).stdout
        self.assertIn("no unknown potentials (all are prescribed), element pressures no\n", summary)

    def test_refuses_what_no_machine_holds(self):
        scene = self.write("a.yaml", SCENE)
        for verb in ("validate", "run"):
            message = self.message(verb, scene, *options(["solids.cube.mesh.box.cells=[270, 270, 270]"]), code=2)
            self.assertRegex(
                message,
                r"a\.yaml:11:3: error: solids\.cube: a mesh of 19683000 cells takes [\d.]+ GiB, more than the [\d.]+ GiB of this "
                r"machine: take fewer cells$",
            )
        self.assertFalse((self.folder / "a.h5").exists())

    def test_probes_that_find_nothing_are_all_told(self):
        probes = (
            "record:\n"
            "  probes:\n"
            '    a: {point: "cube@[0.3, 0, 0]"}\n'
            "    b: {reaction: {solid: cube, where: {point: [1, 1, 1]}}}\n"
            "    c: {average: {solid: cube, where: {box: [[5, ~, ~], [~, ~, ~]]}}}\n"
        )
        message = self.message("validate", self.write("a.yaml", SCENE + probes), code=2)
        self.assertEqual(
            message.replace(f"{self.folder}/", ""),
            "a.yaml:25:16: error: record.probes.a.point: no node is at (0.3, 0, 0); the nearest is node 13 at (0, 0, 0)\n"
            "a.yaml:26:40: error: record.probes.b.reaction.where: no displacement is prescribed there: no reaction\n"
            "a.yaml:27:39: error: record.probes.c.average.where: no node lies in the box; the mesh spans x from -1 to 1, "
            "y from -1 to 1, z from -1 to 1 in its own frame",
        )


if __name__ == "__main__":
    unittest.main()
