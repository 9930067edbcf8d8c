#!/usr/bin/env python3
"""What the state at t = 0 is made from: test_initial_state.py MULDI_SIM."""

import math
import unittest

import h5py

from program import SCENES, ProgramTest, options, values

JOINT = SCENES / "revolute_joint_lumped.yaml"


def largest_difference(left, right):
    return abs(left - right).max()


class EarlierRecord(ProgramTest):
    """`initial.from: earlier.h5`: its last state is t = 0."""

    def check_continues(self, scene, first, second, tolerance, *overrides):
        """A run of `first` and a run of `second` from its record give what an unbroken run gives."""
        both = ["--set", f"dynamics.duration={first + second}", *options(overrides)]
        whole = self.run_scene(scene, "whole.h5", *both)
        self.run_scene(scene, "earlier.h5", "--set", f"dynamics.duration={first}", *options(overrides))
        # The record is looked for in the folder of the scene.
        text = (SCENES / scene).read_text()
        at = text.find("\ninitial:")
        if at >= 0:
            text = text[: at + 1] + text[text.index("\n\n", at) + 1 :]
        here = self.write("later/later.yaml", text.replace("dynamics:", "initial: {from: ../earlier.h5}\n\ndynamics:"))
        later = self.run_scene(here, "later.h5", "--set", f"dynamics.duration={second}", *options(overrides))
        step = values(later, "time")[1]
        begin = round(first / step)
        self.assertEqual(len(values(later, "time")), round(second / step) + 1)
        for name in self.names(whole):
            left, right = values(whole, name)[begin:], values(later, name)
            scale = max(1.0, abs(left).max())
            # At t = 0 the velocity of the following interval is not known yet: both are projected from the momentum.
            self.assertLess(largest_difference(left, right) / scale, tolerance, name)

    def names(self, path):
        with h5py.File(path, "r") as file:
            groups = [f"{family}/{name}" for family in ("bodies", "joints") for name in file.get(family, {})]
            return [f"{group}/{item}" for group in groups for item in file[group] if item != "reaction"]

    # Two roundings that differ by 1e-16 grow by the motion's own instability; none of these is chaotic in this time.
    def test_goes_on_where_the_record_ends_in_a_free_tree(self):
        self.check_continues("tree.yaml", 100, 100, 1e-10)

    def test_goes_on_where_the_record_ends_in_a_closed_loop(self):
        self.check_continues("slider_crank.yaml", 100, 100, 1e-10, "record.every=1")

    def test_goes_on_where_the_record_ends_with_muscles(self):
        self.check_continues("elephant_trunk_lumped.yaml", 100, 100, 1e-10, "record.every=1")


class StaticEquilibrium(ProgramTest):
    def test_stays_at_rest(self):
        output = self.run_scene(JOINT.name, "a.h5", *options(["initial.from=static_equilibrium", "dynamics.duration=2000"]))
        angle = values(output, "joints/hinge/coordinate")[:, 0]
        self.assertAlmostEqual(math.degrees(angle[0]), 7.7284947404, 9)  # independent program
        self.assertLess(abs(angle - angle[0]).max(), 1e-9)
        self.assertLess(abs(values(output, "joints/hinge/velocity")).max(), 1e-9)

    def test_a_system_that_has_none_is_a_failure_of_the_numerics(self):
        message = self.message("run", SCENES / "free_body.yaml", "-o", "a.h5", "--set", "initial.from=static_equilibrium", code=3)
        self.assertEqual(
            message,
            "error: loss_of_equilibrium at t = 0 ms: no static equilibrium under the controls at t = 0: the system can move without any "
            "force: hold it by joints, springs or muscles before asking for its equilibrium (what was computed is in a.h5)\n"
            "  why: pull-in or buckling: beyond this load the system jumps to a state far away, or collapses\n"
            "  try: stay below this load; statics.continuation: arc_length follows the curve past the limit onto the unstable branch, and "
            "dynamics shows where the system goes",
        )


class Momentum(ProgramTest):
    def test_of_a_joint_is_that_of_the_whole_system(self):
        # About a fixed axis the momentum of the joint is the angular momentum: J = 3.17e5 + 40 * 46^2, muscles apart.
        output = self.run_scene("pendulum.yaml", "a.h5", "--set", "initial.momentum.hinge=5000", "--set", "dynamics.duration=10")
        self.assertAlmostEqual(values(output, "momentum/angular")[0][2], 5000, 8)
        self.assertAlmostEqual(values(output, "joints/hinge/velocity")[0][0], 5000 / (3.17e5 + 40 * 46**2), 15)

    def test_counts_the_inertia_of_muscles(self):
        output = self.run_scene(JOINT.name, "a.h5", "--set", "initial.momentum.hinge=5000", "--set", "dynamics.duration=10")
        velocity = values(output, "joints/hinge/velocity")[0][0]
        kinetic = values(output, "energy/kinetic")[0]
        self.assertAlmostEqual(2 * kinetic / velocity, 5000, 8)
        self.assertLess(velocity, 5000 / (3.17e5 + 40 * 46**2))

    def test_moves_the_other_bodies_of_a_chain(self):
        # m_upper = 1000, m_lower = 0: the momentum conjugate to a joint's rate is that of everything beyond it.
        output = self.run_scene("double_pendulum.yaml", "a.h5", *options(["initial.momentum.shoulder=1000", "dynamics.duration=5"]))
        rates = [values(output, f"joints/{name}/velocity")[0][0] for name in ("shoulder", "elbow")]
        # Stretched out: inertia J about each centre, mass m, arms of 100: the 2 x 2 mass matrix in joint rates.
        mass, inertia = 40.0, 1.2e5
        beyond = inertia + mass * 50**2
        both = inertia + mass * 50**2 + inertia + mass * 150**2
        coupling = inertia + mass * 50 * 150
        self.assertAlmostEqual(both * rates[0] + coupling * rates[1], 1000, 8)
        self.assertAlmostEqual(coupling * rates[0] + beyond * rates[1], 0, 8)


if __name__ == "__main__":
    unittest.main()
