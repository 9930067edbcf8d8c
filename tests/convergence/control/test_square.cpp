/// With all controls given and no condition at the end the problem is the forward simulation.
#include <gtest/gtest.h>

#include "support/control_problems.hpp"
#include "support/linkages.hpp"

namespace muldi::control {
namespace {

using test::ControlCase;

/// Fixes the controls of every interval to `u` by the model's own functions and solves from rest.
void expect_simulation(ControlCase& at, const std::vector<std::vector<double>>& u) {
  at.problem.final.momentum.kind = MomentumCondition::Kind::free;
  const Trajectory forward = simulate_guess(at.problem, at.step(), u);
  Trajectory guess = resting_guess(at.problem, at.step());
  guess.u = u;
  const SolveResult result = solve(at.problem, test::feasibility(), guess, {.tolerance = 1e-11});
  EXPECT_EQ(result.status, SolveStatus::optimal) << result.sentence;
  EXPECT_LT(test::distance(*at.model, result.trajectory, forward), 1e-9);
}

/// A control that is held at one value is fixed by its bounds.
void hold(ControlCase& at, const std::vector<double>& values, ControlKind kind) {
  for (std::size_t c = 0; c < values.size(); ++c) {
    at.problem.controls.push_back({.control = static_cast<int>(c),
                                   .kind = kind,
                                   .lower = values[c],
                                   .upper = values[c],
                                   .reference = values[c] != 0.0 ? std::abs(values[c]) : 1.0});
  }
  at.start_at_rest();
  expect_simulation(at, std::vector<std::vector<double>>(static_cast<std::size_t>(at.problem.horizon.n_steps), values));
}

TEST(SquareProblem, PendulumIsTheForwardSimulation) {
  ControlCase at(test::double_pendulum());
  at.set_horizon(20, 5.0);
  hold(at, {}, ControlKind::plain);
}

TEST(SquareProblem, MuscleJointIsTheForwardSimulation) {
  ControlCase at(test::muscle_joint(0.0));
  at.set_horizon(20, 10.0);
  hold(at, {3e4, 1e4}, ControlKind::squared);
}

TEST(SquareProblem, TrunkIsTheForwardSimulation) {
  ControlCase at(test::trunk(std::vector<double>(12, 0.0)));
  at.set_horizon(20, 25.0);
  hold(at, test::odd_fields(3e4), ControlKind::squared);
}

TEST(SquareProblem, FreeBodyIsTheForwardSimulation) {
  ControlCase at(test::driven_free_body());
  at.set_horizon(20, 2.0);
  hold(at, {0.01, 0.02, -0.01, 0.02, -0.03, 0.04}, ControlKind::plain);
}

TEST(SquareProblem, FourBarIsTheForwardSimulation) {
  test::RigidSystem system = test::four_bar({}, test::earth_gravity);
  system.joint_forces.push_back({.joint = 0, .stiffness = 2.0, .damping = 10.0, .control = 0});
  system.controls.push_back({.name = "torque", .unit = {}, .function = 0.0});
  ControlCase at(system);
  at.set_horizon(10, 5.0);
  hold(at, {20.0}, ControlKind::plain);
}

}  // namespace
}  // namespace muldi::control
