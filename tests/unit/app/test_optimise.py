#!/usr/bin/env python3
"""The verb optimise, its results and failures; check --derivatives: test_optimise.py MULDI_SIM."""

import os
import unittest

import h5py

from program import SCENES, ProgramTest, attribute, options, values

JOINT = SCENES / "revolute_joint_optimal.yaml"
SLIDER = SCENES / "double_integrator_optimal.yaml"


class Optimise(ProgramTest):
    def test_writes_the_ordinary_groups_the_optimum_and_the_replay(self):
        done = self.program("optimise", JOINT, "-o", "a.h5")
        self.assertIn("stage 1 of 1, effort: optimal after", done.stdout)
        self.assertIn("sum of squared fields 5763.865", done.stdout)
        self.assertRegex(done.stdout, r"replay less optimum +largest +at the end +afterwards\njoints/hinge +")
        output = self.folder / "a.h5"
        self.assertEqual(attribute(output, "status"), "completed")
        self.assertEqual(values(output, "time").shape, (21,))
        self.assertEqual(values(output, "controls/agonist").shape, (21,))
        self.assertEqual(values(output, "replay/time")[-1], 1000.0)
        self.assertEqual(attribute(output, "status", "optimum/1"), "optimal")
        self.assertGreater(len(values(output, "optimum/1/iterates/iteration")), 2)
        self.assertAlmostEqual(float(values(output, "optimum/1/sum_squared_field")), 5763.8653, delta=0.006)
        self.assertLess(abs(values(output, "solver/residual")).max(), 1e-6)
        self.program("info", "a.h5")

    def test_says_where_a_replay_stopped(self):
        # Coarse muscles under a field that turns their cells inside out.
        fields = "agonist: 150 kV/mm, antagonist: 0"
        replay = f"optimal_control.replay={{step: 1 ms, muscles: fe, then: {{duration: 100 ms, controls: {{{fields}}}}}}}"
        layers = [f"muscles.{name}.fe.layers=3" for name in ("upper", "lower")]
        done = self.program("optimise", JOINT, "-o", "a.h5", *options([*layers, replay]), code=3)
        self.assertRegex(done.stdout, r"\nthe replay stopped at t = 2\d\d ms; up to there\nreplay less optimum +largest +at the end +afterwards\n")

    def test_has_an_american_name(self):
        self.program("optimize", SLIDER, "-o", "a.h5")

    def test_needs_something_to_optimise(self):
        pendulum = SCENES / "pendulum.yaml"
        message = self.message("optimise", pendulum, code=2)
        self.assertEqual(message, f"{pendulum}: error: nothing to optimise: give `optimal_control:`")
        message = self.message("run", SLIDER, code=2)
        self.assertEqual(
            message, f"{SLIDER}: error: nothing to run: give `statics:` or `dynamics:`; for `optimal_control:` there is the verb optimise"
        )

    def test_goes_on_from_an_unfinished_result_with_another_step(self):
        stages = "optimal_control.stages=[{minimise: {effort: {scale: 1.0e-14}}, max_iterations: 3}]"
        done = self.program("optimise", JOINT, "-o", "a.h5", "--set", stages, code=3)
        self.assertIn("iteration_limit", done.stderr)
        self.assertEqual(attribute(self.folder / "a.h5", "status"), "iteration_limit")
        self.assertEqual(values(self.folder / "a.h5", "time").shape, (21,))
        guess = f"optimal_control.guess={{from: {self.folder / 'a.h5'}}}"
        self.program("optimise", JOINT, "-o", "b.h5", *options([guess, "optimal_control.step=5"]))
        self.assertEqual(values(self.folder / "b.h5", "time").shape, (41,))

    def test_goes_on_from_a_result_of_run_with_another_step(self):
        forward = ["dynamics={duration: 200 ms, step: 2 ms}", "record.every=3"]
        self.program("run", JOINT, "-o", "run.h5", *options(forward))
        guess = f"optimal_control.guess={{from: {self.folder / 'run.h5'}}}"
        self.program("optimise", JOINT, "-o", "a.h5", "--set", guess)
        self.assertAlmostEqual(float(values(self.folder / "a.h5", "optimum/1/sum_squared_field")), 5763.8653, delta=0.006)

    def test_starts_on_the_motion_of_a_run_of_the_same_step(self):
        for scene, step in ((JOINT, 10), (SCENES / "four_bar_optimal.yaml", 20), (SCENES / "crane_rest_to_rest.yaml", 50)):
            with self.subTest(scene=scene.stem):
                # Fields at their bounds are moved off these by the solver.
                held = ["controls.antagonist.field=5 kV/mm"] if scene == JOINT else []
                forward = [f"dynamics={{duration: {10 * step}, step: {step}}}", "record.every=1", *held]
                self.program("run", scene, "-o", "run.h5", "--force", *options(forward))
                problem = [f"optimal_control.duration={10 * step}", "optimal_control.final={momentum: free}", "optimal_control.replay={}",
                           f"optimal_control.guess={{from: {self.folder / 'run.h5'}}}"]
                self.program("optimise", scene, "-o", "a.h5", "--force", *options(problem))
                self.assertLess(values(self.folder / "a.h5", "optimum/1/iterates/infeasibility")[0], 1e-9)

    def test_refuses_guesses_from_files_without_a_motion_of_the_system(self):
        self.program("run", SCENES / "pendulum.yaml", "-o", "other.h5", "--set", "dynamics.duration=10 ms")
        static = SCENES / "muscle_force_stretch.yaml"
        self.program("run", static, "-o", "static.h5")
        cases = {"other.h5": "is of another system or records less: it has no controls/agonist", "static.h5": "holds no motion to start from"}
        for name, why in cases.items():
            path = self.folder / name
            message = self.message("optimise", JOINT, "--set", f"optimal_control.guess={{from: {path}}}", code=2)
            self.assertEqual(message, f"--set optimal_control.guess={{from: {path}}}: error: optimal_control.guess: '{path}' {why}")

    def test_is_not_resumed_but_told_how_to_go_on(self):
        message = self.message("optimise", JOINT, "--resume", "a.h5", code=2)
        self.assertEqual(message, "error: 'a.h5' cannot be resumed: the solver of an optimisation keeps no state from which it could go on as if "
                                  "unbroken; start from the last iterate instead, into another file: "
                                  f"--set 'optimal_control.guess={{from: {self.folder.resolve() / 'a.h5'}}}'")

    def test_says_where_an_infeasible_problem_fails(self):
        done = self.program("optimise", SLIDER, "-o", "a.h5", "--set", "optimal_control.controls.push.max=0.01", code=3)
        self.assertIn("error: infeasible", done.stderr)
        self.assertIn("largest violation: ", done.stdout)
        self.assertEqual(attribute(self.folder / "a.h5", "status"), "infeasible")
        with h5py.File(self.folder / "a.h5") as file:
            self.assertNotEqual(file["optimum/1"].attrs["worst_constraint"], "")

    def test_refuses_a_target_out_of_reach_before_the_solve(self):
        target = "optimal_control.final={points: {pendulum.upper: [300, 0, 0]}, momentum: rest}"
        for verb in ("optimise", "validate"):
            message = self.message(verb, JOINT, "--set", target, code=2)
            self.assertIn("optimal_control.final.points", message)

    def test_interrupted_keeps_the_best_iterate(self):
        guess = "optimal_control.guess={random: {starts: 1000, seed: 1}}"
        process = self.start("optimise", SCENES / "elephant_trunk_optimal.yaml", "-o", "a.h5", "--set", guess)
        code = self.interrupt(process, self.folder / "a.h5", 0.5)
        self.assertEqual(code, 130, self.said())
        self.assertEqual(attribute(self.folder / "a.h5", "status"), "interrupted")
        self.assertEqual(values(self.folder / "a.h5", "time").shape, (41,))
        self.assertEqual(values(self.folder / "a.h5", "optimum/trajectory/coordinates").shape[0], 41)


class SolverLibrary(ProgramTest):
    """LD_DEBUG makes the loader say which libraries it opens."""

    def opened(self, *arguments):
        done = self.program(*arguments, env={**os.environ, "LD_DEBUG": "files"})
        return "libipopt" in done.stderr

    def test_is_opened_by_optimise_alone(self):
        self.assertFalse(self.opened("run", SCENES / "pendulum.yaml", "-o", "a.h5", "--set", "dynamics.duration=10 ms"))
        self.assertTrue(self.opened("optimise", SLIDER, "-o", "b.h5"))


class Derivatives(ProgramTest):
    def test_of_every_kind_of_scene_are_right(self):
        for scene in ("revolute_joint_lumped", "four_bar", "slider_crank", "slack_cable", "cube", "round_actuator_lumped", "revolute_joint_optimal",
                      "four_bar_optimal", "boxed_cube_I", "boxed_cube_II", "boxed_cube_III", "membrane_fe", "universal_joint_fe"):
            with self.subTest(scene=scene):
                small = ["--set", "solids.cube.mesh.box.cells=[2, 2, 2]"] if scene == "cube" else []
                done = self.program("check", "--derivatives", SCENES / f"{scene}.yaml", *small)
                self.assertRegex(done.stdout, r"\n[1-9]\d* derivatives, 0 wrong\n$")


if __name__ == "__main__":
    unittest.main()
