#!/usr/bin/env python3
"""Numerics that fail: exit code 3, a sentence, a valid file with what was computed: test_failures.py MULDI_SIM."""

import re
import unittest

from program import SCENES, ProgramTest, attribute, data_sets, options, values


KEPT = " (what was computed is in a.h5)"
WHY = {
    "loss_of_equilibrium": "\n  why: pull-in or buckling: beyond this load the system jumps to a state far away, or collapses"
    "\n  try: stay below this load; statics.continuation: arc_length follows the curve past the limit onto the unstable branch, and dynamics "
    "shows where the system goes",
    "muscle_collapse": "\n  why: pull-in: the field squeezed the muscle faster than its elasticity could resist, or a load crushed it"
    "\n  try: a lower field, or a ramp instead of a jump (a sudden field pulls in at 94 % of the static limit); more viscosity; a smaller "
    "dynamics.step if the field is moderate",
    "inverted_element": "\n  why: a cell of the mesh was pressed through itself, by a field beyond pull-in, a load, or a step that is too large"
    "\n  try: a smaller dynamics.step (for cells that keep their volume below h sqrt(density/stress), h their shortest edge), or a ramp "
    "instead of a jump; a lower field or load; finer or better shaped cells there",
    "step_too_large": "\n  why: the midpoint of two attitudes that far apart is no attitude: the step cannot follow the rotation"
    "\n  try: a dynamics.step in which no body turns by more than about 0.1 rad, or 0.5 at the most",
    "explicit": "\n  why: beyond this step the explicit integrator multiplies every error, and the motion blows up"
    "\n  try: a dynamics.step below the stable one, coarser cells where they are smallest, or integrator: midpoint",
    "no_convergence": "\n  why: Newton's iteration found no next state: too much happens within one step, or the motion is not determined there"
    "\n  try: half the dynamics.step (for cells that keep their volume below h sqrt(density/stress), h their shortest edge); ramps for "
    "controls that jump; more solver.max_iterations; for components of your own `muldi-sim check --derivatives`",
    "statics": "\n  why: no equilibrium was found near the last one, or the system can move without any force"
    "\n  try: more statics.steps, or continuation: arc_length; hold what can move freely by joints, springs or muscles",
    "breakdown": "\n  why: a dielectric that is squeezed carries its voltage over less thickness, and the field in it has grown beyond the "
    "strength of the material\n  try: a lower field or voltage, thicker layers, a load or stop that keeps the material from being squeezed; in "
    "optimal control the limit true_field, below the breakdown_field",
    "rank_change": "\n  why: at a change point a closed mechanism may go on in two ways, and its joints do not say which"
    "\n  try: another scene pose, links of slightly other lengths, or a joint stop that keeps the mechanism off this pose",
}
# Flat: both cranks and the coupler lie on one line.
PARALLELOGRAM = """muldi: 1
bodies:
  left: {mass: 10, inertia: [100, 3000, 3000], position: [25, 0, 0], points: {a: [-25, 0, 0], b: [25, 0, 0]}}
  right: {mass: 10, inertia: [100, 3000, 3000], position: [125, 0, 0], points: {a: [-25, 0, 0], b: [25, 0, 0]}}
  coupler: {mass: 20, inertia: [100, 20000, 20000], position: [100, 0, 0], points: {a: [-50, 0, 0], b: [50, 0, 0]}}
joints:
  A: {type: revolute, from: {body: ground, at: [0, 0, 0]}, to: {body: left, at: a}, axis: [0, 0, 1]}
  B: {type: revolute, from: {body: left, at: b}, to: {body: coupler, at: a}, axis: [0, 0, 1]}
  C: {type: revolute, from: {body: coupler, at: b}, to: {body: right, at: b}, axis: [0, 0, 1]}
  D: {type: revolute, from: {body: right, at: a}, to: {body: ground, at: [100, 0, 0]}, axis: [0, 0, 1]}
initial: {joints: {A: {velocity: 0.02}, C: {velocity: 0.02}}}
dynamics: {duration: 1 s, step: 1 ms}
"""


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
            f"error: loss_of_equilibrium: the equilibrium is lost with control 'supply' between {above:.10g} and {below:.10g} V/mm; there "
            f"muscle 'actuator' is at stretch {values(self.output, 'statics/muscles/actuator/stretch')[-1]:.4g}{KEPT}{WHY['loss_of_equilibrium']}",
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


class LostEquilibriumOfASolid(ProgramTest):
    def test_names_the_cell_at_the_stretch_of_the_closed_form(self):
        """Pull-in of the homogeneous membrane, half a millimetre thick: 58009.6395041 V/mm at the stretch 4^(-1/3)."""
        arguments = [SCENES / "membrane_fe.yaml", "-o", "a.h5", "--set", "statics={control: supply, to: 40 kV, steps: 10}"]
        message = self.message("run", *arguments, code=3)
        where = attribute(self.folder / "a.h5", "status_where")
        found = re.fullmatch(
            r"the equilibrium is lost with control 'supply' between ([\d.]+) and ([\d.]+) V; there cell 0 at \[5, 5, 0\.25\] of solid "
            r"'membrane' is at stretch ([\d.]+)",
            where,
        )
        self.assertIsNotNone(found, where)
        self.assertLess(float(found[1]), 0.5 * LostEquilibrium.CRITICAL)
        self.assertGreater(float(found[2]), 0.5 * LostEquilibrium.CRITICAL)
        self.assertAlmostEqual(float(found[3]), 4 ** (-1 / 3), delta=2e-3)  # the stretch falls as the root of the distance to the limit
        self.assertEqual(message, f"error: loss_of_equilibrium: {where}{KEPT}{WHY['loss_of_equilibrium']}")


class Stability(ProgramTest):
    """Critical fields as in tests/golden/test_snap_through.cpp."""

    def warnings(self, scene, *overrides):
        done = self.program("run", SCENES / scene, "-o", "a.h5", *options(overrides))
        return [line.removeprefix("warning: ") for line in done.stderr.splitlines() if line.startswith("warning: ")]

    def test_of_a_snap_through_is_told_by_both_ways_of_loading(self):
        said = self.warnings("revolute_joint_snap_through.yaml", "statics.continuation=natural")
        self.assertEqual(len(said), 1)
        found = re.fullmatch(
            r"statics: between the loads ([\d.]+) and ([\d.]+) V/mm of 'agonist' the equilibrium jumps to another branch \(snap-through\); "
            r"continuation: arc_length follows the branch that it leaves",
            said[0],
        )
        self.assertIsNotNone(found, said[0])
        self.assertLess(float(found[1]), 17655.306)
        self.assertGreater(float(found[2]), 17655.306)

    def test_of_a_branch_point_is_told_with_what_leads_onto_the_branch(self):
        steps = "statics={control: both, to: 17 kV/mm, steps: 17, continuation: arc_length}"
        said = self.warnings("revolute_joint_fe_shock.yaml", steps, "dynamics.duration=1 ms")
        self.assertEqual(len(said), 1)
        self.assertRegex(
            said[0],
            r"^statics: the stability changes at the load 14889\.37\d* V/mm of 'both', where another branch crosses \(buckling\): a small force "
            r"or offset to one side in the scene leads onto it, as every real system has one$",
        )


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
        self.assertEqual(message, f"error: muscle_collapse at t = {time[-1]:.6g} ms: {where}{KEPT}{WHY['muscle_collapse']}")
        self.assertEqual(attribute(output, "status_time"), time[-1])
        stretch = values(output, "muscles/membrane/stretch")
        self.assertTrue((stretch >= 0.2).all())
        # Up to there it is the run that ends before.
        shorter = self.run_scene(scene, "shorter.h5", *options(["controls.supply.field=80 kV/mm", f"dynamics.duration={time[-2]:.2f}"]))
        n = len(values(shorter, "time"))
        self.assertEqual(values(shorter, "muscles/membrane/length").tobytes(), values(output, "muscles/membrane/length")[:n].tobytes())


class Breakdown(ProgramTest):
    """Uniaxial equilibrium of a free ideal dielectric under the true field e: L^3 + (eps e^2/mu) L = 1, nominal field e L."""

    STRENGTH = "materials.silicone.electric.breakdown_field=40 kV/mm"
    NOMINAL = 37010.76473331029  # V/mm, at stretch 0.9252691183327572, permittivity 3.7 and Young's modulus 0.7 MPa
    RAMP = {"field": "controls.supply.field={ramp: {from: 0, to: 40 kV/mm, start: 0, over: 40 ms}}",
            "potential": "controls.supply.potential={ramp: {from: 0, to: 20 kV, start: 0, over: 40 ms}}"}

    def assert_is_said(self, message, pattern):
        where = attribute(self.folder / "a.h5", "status_where")
        self.assertEqual(attribute(self.folder / "a.h5", "status"), "breakdown")
        self.assertRegex(where, pattern + r" in its deformed material, beyond the breakdown_field of 'silicone', 40000 V/mm$")
        time = attribute(self.folder / "a.h5", "status_time")
        at = "" if time != time else f" at t = {time:.6g} ms"
        self.assertEqual(message, f"error: breakdown{at}: {where}{KEPT}{WHY['breakdown']}")

    def without_statics(self, scene):
        return self.write(scene, (SCENES / scene).read_text().replace("statics: {steps: 6}\n", ""))

    def test_on_a_ramp_comes_at_the_time_of_the_closed_form(self):
        """The ramps reach the critical field at 37.0108 ms; the membrane lags behind by less than a step of 0.01 ms."""
        scenes = {"membrane_lumped.yaml": ("field", r"muscle 'membrane'"),
                  "membrane_fe.yaml": ("potential", r"cell 0 at \[5, 5, 0\.25\] of solid 'membrane'")}
        for scene, (quantity, place) in scenes.items():
            with self.subTest(scene=scene):
                overrides = options([self.STRENGTH, self.RAMP[quantity], "dynamics.duration=40 ms"])
                message = self.message("run", self.without_statics(scene), "-o", "a.h5", "--force", *overrides, code=3)
                time = values(self.folder / "a.h5", "time")
                self.assertLess(time[-1], self.NOMINAL / 1000)
                self.assertGreater(time[-1] + 0.01, self.NOMINAL / 1000)
                self.assertEqual(attribute(self.folder / "a.h5", "status_time"), time[-1])
                self.assert_is_said(message, rf"^in the step to t = 37\.02 ms {place} reaches a field of 400\d\d\.?\d* V/mm")
                self.program("info", "a.h5")

    def test_is_recorded_up_to_the_last_node_below_the_strength(self):
        overrides = options([self.RAMP["field"], "dynamics.duration=40 ms"])
        self.message("run", self.without_statics("membrane_lumped.yaml"), "-o", "a.h5", *overrides, *options([self.STRENGTH]), code=3)
        self.run_scene(self.folder / "membrane_lumped.yaml", "free.h5", *overrides)
        field = values(self.folder / "free.h5", "muscles/membrane/true_field")
        n = int((field > 40_000).argmax())
        self.assertEqual(field[:n].tobytes(), values(self.folder / "a.h5", "muscles/membrane/true_field").tobytes())

    def test_of_equilibria_lies_between_two_loads(self):
        overrides = [self.STRENGTH, "statics.continuation=natural", "statics.steps=6000"]
        message = self.message("run", SCENES / "pull_in.yaml", "-o", "a.h5", *options(overrides), code=3)
        self.assertEqual(values(self.folder / "a.h5", "statics/load")[-1], 37_010)
        self.assert_is_said(message, r"^with control 'supply' at 37010 to 37020 V/mm muscle 'actuator' reaches a field of 400\d\d\.?\d* V/mm")

    def test_of_equilibria_under_all_controls_names_the_load_and_the_cell(self):
        """18505.382 V over the thickness of 0.5 mm are 0.92527 of 20 kV."""
        overrides = [self.STRENGTH, "controls.supply.potential=20 kV", "statics.steps=1000"]
        message = self.message("run", SCENES / "membrane_fe.yaml", "-o", "a.h5", *options(overrides), code=3)
        self.assert_is_said(message, r"^at the load 0\.925 to 0\.926 cell 0 at \[5, 5, 0\.25\] of solid 'membrane' reaches a field of 400\d\d\.?\d* V/mm")

    def test_at_the_start_is_told_with_the_one_row_that_there_is(self):
        message = self.message("run", self.without_statics("membrane_lumped.yaml"), "-o", "a.h5", *options([self.STRENGTH, "controls.supply.field=-50 kV/mm"]), code=3)
        warning, message = message.split("\n", 1)
        self.assertTrue(
            warning.endswith(
                ": warning: muscles.membrane: its control 'supply' gives a field of 50000 V/mm in the undeformed muscle, beyond the "
                "breakdown_field of 'silicone', 40000 V/mm: the run ends there with `breakdown` unless the muscle is stretched"
            ),
            warning,
        )
        self.assert_is_said(message, r"^muscle 'membrane' reaches a field of 50000 V/mm")
        self.assertEqual(list(values(self.folder / "a.h5", "time")), [0.0])

    def test_of_a_meshed_muscle_names_muscle_and_cell(self):
        overrides = ["materials.silicone.electric.breakdown_field=40 kV/mm", "controls.agonist.field=39.9 kV/mm", "muscles.upper.model=fe", "muscles.lower.model=fe",
                     "dynamics.duration=20 ms"]
        scene = self.write("joint.yaml", (SCENES / "revolute_joint_twin.yaml").read_text())
        message = self.message("run", scene, "-o", "a.h5", *options(overrides), code=3)
        self.assert_is_said(message, r"cell \d+ at \[[^\]]*\] of muscle 'upper' reaches a field of 4\d{4}\.?\d* V/mm")

    def test_is_not_looked_for_where_the_strength_is_not_reached_or_not_given(self):
        for scene in ("membrane_lumped.yaml", "membrane_fe.yaml"):
            strong = self.run_scene(scene, "strong.h5", "--force", *options(["materials.silicone.electric.breakdown_field=100 kV/mm"]))
            self.assertEqual(data_sets(strong), data_sets(self.run_scene(scene, "none.h5", "--force")))


class TooLargeSteps(ProgramTest):
    """The plate turns by 0.1 rad/ms."""

    def test_beyond_1_rad_are_refused_by_name(self):
        for step, turn in ((12, "1.2"), (25, "2.5"), (50, "5")):
            with self.subTest(step=step):
                arguments = [SCENES / "free_body.yaml", "-o", "a.h5", "--force", *options([f"dynamics.step={step}", f"dynamics.duration={100 * step}"])]
                message = self.message("run", *arguments, code=3)
                sentence = f"body 'plate' turns by {turn} rad in one step (limit 1): use a smaller step"
                self.assertEqual(message, f"error: step_too_large at t = 0 ms: {sentence}{KEPT}{WHY['step_too_large']}")
                output = self.folder / "a.h5"
                self.assertEqual(attribute(output, "status"), "step_too_large")
                self.assertEqual(list(values(output, "time")), [0.0])
                self.assertEqual(list(values(output, "bodies/plate/angular_velocity")[0].round(12)), [0.0005, 0.1, 0.0])

    def test_beyond_half_a_rad_are_warned_of_once(self):
        done = self.program("run", SCENES / "free_body.yaml", "-o", "a.h5", "--set", "dynamics.step=8")
        self.assertEqual(
            done.stderr,
            "warning: at t = 8 ms: body 'plate' turns by 0.927 rad in one step; results lose accuracy: take a smaller dynamics.step\ncompleted: a.h5\n",
        )

    def test_below_are_not(self):
        self.assertEqual(self.program("run", SCENES / "free_body.yaml", "-o", "a.h5", "--set", "dynamics.step=4").stderr, "completed: a.h5\n")


class NoConvergence(ProgramTest):
    def test_is_told_with_the_number_of_iterations(self):
        message = self.message("run", SCENES / "double_pendulum.yaml", "-o", "a.h5", "--set", "solver.max_iterations=1", code=3)
        self.assertEqual(message, f"error: no_convergence at t = 0 ms: no convergence in 1 Newton iterations{KEPT}{WHY['no_convergence']}")
        self.assertEqual(attribute(self.folder / "a.h5", "status"), "no_convergence")
        self.assertEqual(list(values(self.folder / "a.h5", "time")), [0.0])

    def test_of_statics_without_stiffness_says_what_to_hold(self):
        message = self.message("run", SCENES / "free_body.yaml", "-o", "a.h5", "--set", "statics.steps=3", code=3)
        self.assertEqual(
            message,
            "error: no_convergence: the system can move without any force: hold it by joints, springs or muscles before asking for its "
            f"equilibrium{KEPT}{WHY['statics']}",
        )


class InvertedElement(ProgramTest):
    def test_names_its_cell(self):
        """A membrane under a sudden field beyond its dynamic pull-in."""
        scene = self.write("a.yaml", (SCENES / "membrane_fe.yaml").read_text().replace("statics: {steps: 6}\n", ""))
        message = self.message("run", scene, "-o", "a.h5", "--set", "controls.supply.potential=30 kV", code=3)
        time, where = attribute(self.folder / "a.h5", "status_time"), attribute(self.folder / "a.h5", "status_where")
        self.assertRegex(where, r"^solid 'membrane': cell 0 at \[5, 5, 0\.25\] is inverted \(det F -?[0-9.e-]+\)$")
        warning = f"warning: at t = {time:.6g} ms: {where}\n"
        self.assertEqual(message, f"{warning}error: inverted_element at t = {time:.6g} ms: {where}{KEPT}{WHY['inverted_element']}")


class ExplicitStep(ProgramTest):
    def test_beyond_the_stable_one_is_refused(self):
        overrides = ["solids.cube.mesh.box.cells=[2, 2, 2]", "materials.polymer.viscous.viscosity=0", "dynamics.integrator=explicit"]
        text = (SCENES / "cube.yaml").read_text()
        scene = self.write("a.yaml", "".join(line for line in text.splitlines(True) if "viscous:" not in line))
        overrides = [overrides[0], overrides[2], "dynamics.step=0.01"]
        message = self.message("run", scene, "-o", "a.h5", *options(overrides), code=3).split("\n", 1)[1]
        where = attribute(self.folder / "a.h5", "status_where")
        self.assertRegex(where, r"^the explicit integrator is stable for steps below 0\.00\d+ \(2/omega of the fastest wave in the mesh\), the step is 0\.01: ")
        self.assertEqual(message, f"error: step_too_large at t = 0 ms: {where}{KEPT}{WHY['explicit']}")


class ChangePoint(ProgramTest):
    def test_in_the_scene_pose_of_a_parallelogram_is_told(self):
        message = self.message("run", self.write("a.yaml", PARALLELOGRAM), "-o", "a.h5", code=3)
        sentence = "the loop constraints have a higher rank than in the scene pose, which is a change point of the mechanism: give another scene pose"
        self.assertEqual(message, f"error: rank_change at t = 1 ms: {sentence}{KEPT}{WHY['rank_change']}")


class Buckling(ProgramTest):
    def test_is_warned_of_with_place_and_time(self):
        done = self.program("run", SCENES / "revolute_joint_lumped.yaml", "-o", "a.h5", *options(["initial.joints.hinge.velocity=0.01", "dynamics.duration=20"]))
        self.assertRegex(
            done.stderr,
            r"^warning: at t = 8 ms: muscle 'upper': compressed with 0\.4\d+ beyond its buckling load 0\.4\d+ as a slender pinned rod; a lumped "
            r"muscle stays straight: where that matters take `model: fe`, a shorter or thicker muscle, or less compression\ncompleted: a\.h5\n$",
        )


class Chaos(ProgramTest):
    def runs(self, scene, duration):
        self.run_scene(scene, "a.h5", *options([f"dynamics.duration={duration}"]))
        self.run_scene(scene, "b.h5", *options([f"dynamics.duration={duration}", "gravity[1]=-9.81000000001 m/s^2"]))
        return self.program("compare", "a.h5", "b.h5", code=1).stdout.splitlines()

    def test_is_told_where_two_runs_drift_apart_exponentially(self):
        said = self.runs("double_pendulum.yaml", "10 s")
        self.assertRegex(
            said[-3], r"^exponential growth: /bodies/\w+/\w+ drifts apart tenfold every \d\.\d+e\+03 ms, from round-off at t = \d+ ms( to .*)?$"
        )
        self.assertEqual(
            said[-2:],
            [
                "  why: an unstable or chaotic motion forgets its start, round-off is enough: neither of the two is wrong",
                "  try: compare energies and momenta (--only 'energy/*' --only 'momentum/*'), or a shorter time",
            ],
        )

    def test_is_not_suspected_of_regular_motion(self):
        self.run_scene("pendulum.yaml", "a.h5", *options(["dynamics.duration=5 s"]))
        self.run_scene("pendulum.yaml", "b.h5", *options(["dynamics.duration=5 s", "gravity[1]=-9.811 m/s^2"]))
        self.assertNotIn("exponential", self.program("compare", "a.h5", "b.h5", code=1).stdout)


class Replay(ProgramTest):
    def test_that_stops_is_told_as_such_and_not_as_an_optimiser_that_failed(self):
        replay = "optimal_control.replay={step: 10 ms, muscles: fe}"
        said = self.program("optimise", SCENES / "revolute_joint_optimal.yaml", "-o", "a.h5", *options([replay, "solver.max_iterations=2"]), code=3).stderr
        where = attribute(self.folder / "a.h5", "status_where")
        self.assertEqual(where, "replay: no convergence in 2 Newton iterations")
        self.assertEqual(
            said.splitlines()[1:],
            [
                f"error: no_convergence at t = {attribute(self.folder / 'a.h5', 'status_time'):.6g} ms: {where} (the optimum is in a.h5)",
                "  why: the controls were found; replaying them, Newton's iteration found no next state: held fields jump by what the step of "
                "the replay cannot follow",
                "  try: half the optimal_control.replay.step; interpolation: linear; a rate in the objective",
            ],
        )


class OptimalControl(ProgramTest):
    def last_words(self, *arguments):
        done = self.program("optimise", *arguments, code=3)
        return [line for line in done.stderr.splitlines() if not line.startswith("stage ")]

    def test_says_what_is_infeasible_and_what_to_try(self):
        slider = SCENES / "double_integrator_optimal.yaml"
        said = self.last_words(slider, "-o", "a.h5", "--set", "optimal_control.controls.push.max=0.01")
        self.assertRegex(
            said[0],
            r"^error: infeasible at t = \d+ ms: no motion near the guess fulfils all conditions: the violation has a minimum there; the "
            r"largest violation is that of [\w. ]+ \(the best iterate is in a\.h5\)$",
        )
        self.assertEqual(
            said[1:],
            [
                "  why: no controls within their bounds meet all conditions, as far as can be told from this guess",
                "  try: a longer duration, wider bounds or limits, or fewer conditions at the end (the largest violation says which is in the "
                "way); another guess",
            ],
        )

    def test_says_how_to_go_on_from_the_limit_of_iterations(self):
        stages = "optimal_control.stages=[{minimise: {effort: {scale: 1.0e-14}}, max_iterations: 3}]"
        said = self.last_words(SCENES / "revolute_joint_optimal.yaml", "-o", "a.h5", "--set", stages)
        self.assertRegex(
            said[0],
            r"^error: iteration_limit at t = \d+ ms: the limit of iterations is reached; the best iterate so far is kept; the largest "
            r"violation is that of equation of motion \(the best iterate is in a\.h5\)$",
        )
        self.assertEqual(
            said[1:],
            [
                "  why: the optimiser was stopped on its way; its best iterate is kept",
                "  try: more max_iterations in this stage, or go on from the result with guess: {from: FILE}",
            ],
        )


if __name__ == "__main__":
    unittest.main()
