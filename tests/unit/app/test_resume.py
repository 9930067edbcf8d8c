#!/usr/bin/env python3
"""Interrupted runs go on bit for bit: test_resume.py MULDI_SIM."""

import signal
import unittest

from program import SCENES, BrokenRuns, ProgramTest, attribute, options, values

# Scene, overrides; each some tenths of a second long.
RUNS = {
    "trunk, statics first": ("elephant_trunk_lumped.yaml", ["dynamics.duration=30 s"]),
    "closed and redundant": ("four_bar.yaml", ["dynamics.duration=20 s"]),
    "closed, springs, a row in 7 steps": ("slider_crank.yaml", ["dynamics.duration=21 s", "record.every=7"]),
    "isolated actuator": ("membrane_lumped.yaml", ["dynamics.duration=3000", "record.every=5"]),
    "accounts of the supply": (
        "energy_harvester.yaml",
        [
            "dynamics.duration=30 s",
            "record.every=3",
            "controls.supply.layer_voltage={sine: {amplitude: 300, frequency: 0.02}}",
            "materials.silicone.viscous={model: kelvin_voigt, viscosity: 0.05}",
        ],
    ),
    "free tree, a row in 30 steps": ("tree.yaml", ["dynamics.duration=20 s", "record.every=30"]),
}


class Interrupted(BrokenRuns):
    def test_an_interrupted_run_goes_on_with_the_same_bits(self):
        for name, (scene, overrides) in RUNS.items():
            with self.subTest(name):
                arguments = [SCENES / scene, *options(overrides)]
                whole = self.folder / "whole.h5"
                self.program("run", *arguments, "-o", whole)
                broken = self.folder / "broken.h5"
                # Interrupts that come too late prove nothing: then again.
                interrupts = 0
                while interrupts < 2:
                    codes = self.run_with_breaks(arguments, broken, [0.0, 0.01, 0.02, 0.05])
                    interrupts += codes.count(130)
                    self.assertLessEqual(set(codes), {0, 130})
                    self.assertEqual(attribute(broken, "status"), "completed")
                    self.assert_same_bits(whole, broken)
                    broken.unlink()
                whole.unlink()

    def break_once(self, arguments, output):
        """Runs it with an interrupt early on, again where that came too late, and goes on to the end."""
        codes = []
        while codes != [130, 0]:
            output.unlink(missing_ok=True)
            codes = self.run_with_breaks(arguments, output, [0.05])
            self.assertIn(codes, ([130, 0], [0]))

    def test_an_interrupted_file_says_so_and_ends_with_a_row_of_that_moment(self):
        output = self.folder / "a.h5"
        process = self.start("run", SCENES / "tree.yaml", "-o", output, *options(["dynamics.duration=1000 s", "record.every=30"]))
        self.assertEqual(self.interrupt(process, output, 0.1), 130)
        self.assertEqual(attribute(output, "status"), "interrupted")
        self.assertEqual(attribute(output, "status_where"), "interrupted by the user")
        self.assertEqual(attribute(output, "status_time"), values(output, "time")[-1])
        self.assertIn("status         interrupted at ", self.program("info", output).stdout)

    def test_sigterm_is_an_interrupt(self):
        output = self.folder / "a.h5"
        process = self.start("run", SCENES / "tree.yaml", "-o", output, *options(["dynamics.duration=1000 s", "record.every=30"]))
        self.assertEqual(self.interrupt(process, output, 0.05, signal.SIGTERM), 130)
        self.assertEqual(attribute(output, "status"), "interrupted")

    def test_statics_broken_off_are_done_again(self):
        arguments = [SCENES / "revolute_joint_lumped.yaml", *options(["statics.steps=100000", "dynamics.duration=10"])]
        whole, broken = self.folder / "whole.h5", self.folder / "broken.h5"
        self.program("run", *arguments, "-o", whole)
        self.break_once(arguments, broken)
        self.assert_same_bits(whole, broken)

    def test_statics_alone_broken_off_are_done_again(self):
        scene = self.write("a.yaml", (SCENES / "revolute_joint_lumped.yaml").read_text().replace("dynamics: {duration: 1 s, step: 1 ms}\n", ""))
        arguments = [scene, *options(["statics.steps=100000"])]
        whole, broken = self.folder / "whole.h5", self.folder / "broken.h5"
        self.program("run", *arguments, "-o", whole)
        self.break_once(arguments, broken)
        self.assert_same_bits(whole, broken)

    def test_a_longer_duration_goes_on_like_the_longer_run(self):
        for scene, overrides in RUNS.values():
            with self.subTest(scene):
                step = {"membrane_lumped.yaml": 0.01}.get(scene, 1)
                # The short run ends between two rows where not every step is recorded.
                first, longer = ([f"dynamics.duration={n * step}", *overrides[1:]] for n in (500, 2100))
                self.program("run", SCENES / scene, "-o", "whole.h5", *options(longer))
                self.program("run", SCENES / scene, "-o", "short.h5", *options(first))
                done = self.program("run", SCENES / scene, "--resume", "short.h5", *options(longer))
                self.assertEqual(done.stderr, "completed: short.h5\n")
                self.assert_same_bits("whole.h5", "short.h5")
                self.assertEqual(attribute(self.folder / "short.h5", "scene"), attribute(self.folder / "whole.h5", "scene"))
                for name in ("whole.h5", "short.h5"):
                    (self.folder / name).unlink()

    def test_attached_solids_go_on_like_the_longer_run(self):
        overrides = [
            "statics.steps=1",
            "controls.supply.potential=3 kV",
            "solids.active.mesh.box.cells=[6, 4, 2]",
            "solids.passive.mesh.box.cells=[6, 2, 1]",
            "solids.passive.attach=[]",
            "solids.active.attach=[{where: z-, solid: passive, where_other: z+}]",
            "record.fields={active: [position, velocity, stress], passive: [position]}",
        ]
        short, longer = (options([f"dynamics={{duration: {n} us, step: 100 us}}", *overrides]) for n in (700, 2000))
        self.program("run", SCENES / "bimorph.yaml", "-o", "whole.h5", *longer)
        self.program("run", SCENES / "bimorph.yaml", "-o", "short.h5", *short)
        self.program("run", SCENES / "bimorph.yaml", "--resume", "short.h5", *longer)
        self.assert_same_bits("whole.h5", "short.h5")


class Refused(ProgramTest):
    """A record that is complete or of another scene is left byte for byte as it is."""

    def setUp(self):
        super().setUp()
        self.output = self.run_scene("pendulum.yaml", "a.h5")
        self.before = self.output.read_bytes()

    def resume(self, *overrides, code):
        done = self.program("run", SCENES / "pendulum.yaml", "--resume", "a.h5", *options(overrides), code=code)
        self.assertEqual(self.output.read_bytes(), self.before)
        return done.stderr

    def test_a_complete_record_needs_nothing(self):
        self.assertEqual(self.resume(code=0), "'a.h5' is complete already: nothing to do (a longer dynamics.duration would go on)\n")

    def test_another_scene(self):
        why = "error: 'a.h5' cannot be resumed: it is of another scene: the record has {}, the scene {}\n"
        self.assertEqual(self.resume("bodies.pendulum.mass=50", code=2), why.format("'mass: 40'", "'mass: 50'"))
        step = "'dynamics: {{duration: 2000, step: {}, integrator: midpoint}}'"
        self.assertEqual(self.resume("dynamics.step=2.5", code=2), why.format(step.format(5), step.format(2.5)))
        self.assertEqual(self.resume("record.every=2", code=2), why.format("""'record: {every: 1, points: ["pendulum.tip"]}'""", """'record: {every: 2, points: ["pendulum.tip"]}'"""))

    def test_a_shorter_duration(self):
        message = self.resume("dynamics.duration=1 s", code=2)
        self.assertEqual(message, "error: 'a.h5' cannot be resumed: it has reached t = 2000 already, beyond dynamics.duration: 1000\n")


if __name__ == "__main__":
    unittest.main()
