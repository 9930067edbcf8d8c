#!/usr/bin/env python3
"""Numerics that fail: exit code 3, a sentence, a valid file with what was computed: test_failures.py MULDI_SIM."""

import unittest

from program import SCENES, ProgramTest, attribute, options, values


class LostEquilibrium(ProgramTest):
    CRITICAL = 58009.6395041  # V/mm, closed form of the free ideal dielectric

    def setUp(self):
        super().setUp()
        arguments = [SCENES / "pull_in.yaml", "-o", "a.h5", "--set", "statics.continuation=natural"]
        self.said = self.message("run", *arguments, code=3)
        self.output = self.folder / "a.h5"

    def test_is_bracketed(self):
        above = attribute(self.output, "critical_load_above", "statics")
        below = attribute(self.output, "critical_load_below", "statics")
        self.assertLess(above, self.CRITICAL)
        self.assertGreater(below, self.CRITICAL)
        self.assertLess(below - above, 1e-6 * 60_000)
        self.assertEqual(
            self.said,
            f"error: loss_of_equilibrium: the equilibrium is lost at a load between {above:.10g} and {below:.10g} (what was computed is in a.h5)",
        )

    def test_is_the_status_and_keeps_the_stable_branch(self):
        self.assertEqual(attribute(self.output, "status"), "loss_of_equilibrium")
        load = values(self.output, "statics/load")
        self.assertEqual(list(load[:-1]), [2000.0 * k for k in range(30)])
        self.assertEqual(load[-1], attribute(self.output, "critical_load_above", "statics"))
        self.assertTrue((values(self.output, "statics/stable") == 1).all())
        stretch = values(self.output, "statics/muscles/actuator/stretch")
        self.assertTrue((stretch > 4 ** (-1 / 3)).all())
        self.program("info", "a.h5")


class Collapse(ProgramTest):
    def test_keeps_the_rows_up_to_the_last_good_node(self):
        text = (SCENES / "membrane_lumped.yaml").read_text().replace("statics: {steps: 6}\n", "")
        scene = self.write("a.yaml", text)
        message = self.message("run", scene, "-o", "a.h5", "--set", "controls.supply.field=80 kV/mm", code=3)
        output = self.folder / "a.h5"
        self.assertEqual(attribute(output, "status"), "muscle_collapse")
        time = values(output, "time")
        where = attribute(output, "status_where")
        self.assertRegex(where, r"^muscle 'membrane': stretch 0\.[12]\d* below 0\.2$")
        self.assertEqual(message, f"error: muscle_collapse at t = {time[-1]:.6g}: {where} (what was computed is in a.h5)")
        self.assertEqual(attribute(output, "status_time"), time[-1])
        stretch = values(output, "muscles/membrane/stretch")
        self.assertTrue((stretch >= 0.2).all())
        # Up to there it is the run that ends before.
        shorter = self.run_scene(scene, "shorter.h5", *options(["controls.supply.field=80 kV/mm", f"dynamics.duration={time[-2]:.2f}"]))
        n = len(values(shorter, "time"))
        self.assertEqual(values(shorter, "muscles/membrane/length").tobytes(), values(output, "muscles/membrane/length")[:n].tobytes())


class TooLargeSteps(ProgramTest):
    """The plate turns by 0.1 rad/ms."""

    def test_beyond_1_rad_are_refused_by_name(self):
        for step, turn in ((12, "1.2"), (25, "2.5"), (50, "5")):
            with self.subTest(step=step):
                arguments = [SCENES / "free_body.yaml", "-o", "a.h5", "--force", *options([f"dynamics.step={step}", f"dynamics.duration={100 * step}"])]
                message = self.message("run", *arguments, code=3)
                sentence = f"a body turns by {turn} rad in one step (limit 1): use a smaller step"
                self.assertEqual(message, f"error: step_too_large at t = 0: {sentence} (what was computed is in a.h5)")
                output = self.folder / "a.h5"
                self.assertEqual(attribute(output, "status"), "step_too_large")
                self.assertEqual(list(values(output, "time")), [0.0])
                self.assertEqual(list(values(output, "bodies/plate/angular_velocity")[0].round(12)), [0.0005, 0.1, 0.0])

    def test_beyond_half_a_rad_are_warned_of_once(self):
        done = self.program("run", SCENES / "free_body.yaml", "-o", "a.h5", "--set", "dynamics.step=8")
        self.assertEqual(
            done.stderr,
            "warning: at t = 8 a body turns by 0.927 rad in one step; results lose accuracy, use a smaller step\ncompleted: a.h5\n",
        )

    def test_below_are_not(self):
        self.assertEqual(self.program("run", SCENES / "free_body.yaml", "-o", "a.h5", "--set", "dynamics.step=4").stderr, "completed: a.h5\n")


class NoConvergence(ProgramTest):
    def test_is_told_with_the_number_of_iterations(self):
        message = self.message("run", SCENES / "double_pendulum.yaml", "-o", "a.h5", "--set", "solver.max_iterations=1", code=3)
        self.assertEqual(message, "error: no_convergence at t = 0: no convergence in 1 Newton iterations (what was computed is in a.h5)")
        self.assertEqual(attribute(self.folder / "a.h5", "status"), "no_convergence")
        self.assertEqual(list(values(self.folder / "a.h5", "time")), [0.0])

    def test_of_statics_without_stiffness_says_what_to_hold(self):
        message = self.message("run", SCENES / "free_body.yaml", "-o", "a.h5", "--set", "statics.steps=3", code=3)
        self.assertEqual(
            message,
            "error: no_convergence: the system can move without any force: hold it by joints, springs or muscles before asking for its "
            "equilibrium (what was computed is in a.h5)",
        )


if __name__ == "__main__":
    unittest.main()
