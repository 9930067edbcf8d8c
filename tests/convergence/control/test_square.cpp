/// With all controls given and no condition at the end the problem is the forward simulation.
#include <gtest/gtest.h>

#include <cmath>

#include "support/control_problems.hpp"
#include "support/linkages.hpp"
#include "variational/node_values.hpp"
#include "variational/stepper.hpp"

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

TEST(SquareProblem, FourBarDrivenAtTheJointThatClosesItIsTheForwardSimulation) {
  test::RigidSystem system = test::four_bar({}, test::earth_gravity);
  system.joint_forces.push_back({.joint = 3, .stiffness = 2.0, .damping = 10.0, .control = 0});
  system.controls.push_back({.name = "torque", .unit = {}, .function = 0.0});
  ControlCase at(system);
  at.set_horizon(10, 5.0);
  hold(at, {20.0}, ControlKind::plain);
}

TEST(SquareProblem, InitialVelocityIsThatOfTheForwardSimulation) {
  const Eigen::VectorXd rates = Eigen::VectorXd::Constant(1, 2e-3);
  const double angle = 0.1;
  const std::vector<std::vector<double>> u(10, {3e4, 1e4});
  ControlCase given(test::muscle_joint(0.0));
  given.set_horizon(10, 10.0);
  given.problem.initial.coordinates = {{.name = "joints.hinge", .rate = 0, .value = angle}};
  given.problem.initial.momentum = {.kind = MomentumCondition::Kind::rates, .values = rates};
  const Trajectory forward = simulate_guess(given.problem, 10.0, u);
  EXPECT_GT(std::abs(forward.x[1][0] - angle), 1e-3);

  // The same pose by a point, so that pose and momentum are unknowns.
  ControlCase sought(test::muscle_joint(0.0));
  sought.set_horizon(10, 10.0);
  sought.problem.initial.points = {{.name = "points.end",
                                    .point = multibody::body_point(0, Eigen::Vector3d(46.0, 0.0, 0.0)),
                                    .value = {92.0 * std::cos(angle), 92.0 * std::sin(angle), std::nullopt}}};
  sought.problem.initial.momentum = given.problem.initial.momentum;
  for (ControlCase* at : {&given, &sought}) {
    at->problem.final.momentum.kind = MomentumCondition::Kind::free;
    for (int c = 0; c < 2; ++c) {
      const double field = u[0][static_cast<std::size_t>(c)];
      at->problem.controls.push_back(
          {.control = c, .kind = ControlKind::squared, .lower = field, .upper = field, .reference = field});
    }
    Trajectory guess = resting_guess(at->problem, 10.0);
    const SolveResult result = solve(at->problem, test::feasibility(), guess, {.tolerance = 1e-11});
    ASSERT_EQ(result.status, SolveStatus::optimal) << result.sentence;
    EXPECT_LT(test::distance(*at->model, result.trajectory, forward), 1e-9);
  }
}

TEST(FinalVelocity, IsTheOneThatIsAskedFor) {
  // The rate of the last node, from the momentum of the forward run, is the wanted one.
  ControlCase at = test::joint_case(20, 10.0);
  at.problem.final.coordinates.clear();
  at.problem.final.points = {{.name = "points.end",
                              .point = multibody::body_point(0, Eigen::Vector3d(46.0, 0.0, 0.0)),
                              .value = {std::nullopt, 92.0 * std::sin(0.1), std::nullopt}}};
  at.problem.final.momentum = {.kind = MomentumCondition::Kind::rates, .values = Eigen::VectorXd::Constant(1, 1e-3)};
  const SolveResult result =
      solve(at.problem, test::effort_of_fields(2), resting_guess(at.problem, 10.0), {.tolerance = 1e-11});
  ASSERT_EQ(result.status, SolveStatus::optimal) << result.sentence;
  variational::State state = test::state_at_rest(*at.model);
  variational::Stepper stepper(*at.model, 10.0, {});
  for (const auto& u : result.trajectory.u) stepper.advance(state, u);
  variational::NodeEvaluator nodes(*at.model, "auto");
  variational::NodeValues values;
  ASSERT_TRUE(nodes.evaluate(state, result.trajectory.u.back(), result.trajectory.u.back(), values));
  EXPECT_NEAR(values.rate[0], 1e-3, 1e-10);
  EXPECT_NEAR(state.x[0], 0.1, 1e-9);
}

}  // namespace
}  // namespace muldi::control
