/// Problems whose discrete optimum is known.
///
/// A mass m from rest to rest over the distance d by a force held over each of N steps h: the midpoint discretisation
/// is sum u_j = 0, h^2/m sum c_j u_j = d with c_j = (N - 1)/2 - j.
#include <gtest/gtest.h>

#include <cmath>

#include "support/control_problems.hpp"

namespace muldi::control {
namespace {

using test::ControlCase;

constexpr double mass = 2.0;
constexpr double distance = 0.5;

ControlCase rest_to_rest(int n_steps, double step, double bound) {
  ControlCase at(test::slider());
  at.set_horizon(n_steps, step);
  at.problem.controls = {{.control = 0, .lower = -bound, .upper = bound, .reference = 1.0}};
  at.start_at_rest();
  at.problem.final.coordinates = {{.name = "joints.slider", .rate = 0, .value = distance}};
  return at;
}

TEST(DoubleIntegrator, EffortIsThatOfTheDiscreteClosedForm) {
  // u_j = alpha c_j with sum c_j^2 = N (N^2 - 1)/12.
  const int n = 20;
  const double h = 0.1;
  const ControlCase at = rest_to_rest(n, h, 100.0);
  const std::vector<WeightedObjective> effort{{1.0, Effort{.factors = {1.0}}}};
  const SolveResult result = solve(at.problem, effort, resting_guess(at.problem, h), {});
  ASSERT_EQ(result.status, SolveStatus::optimal) << result.sentence;
  const double impulse = distance * mass / (h * h);
  const double squares = n * (n * n - 1.0) / 12.0;
  EXPECT_NEAR(result.objective, impulse * impulse / squares, 1e-9 * result.objective);
  for (int j = 0; j < n; ++j) {
    const double expected = impulse / squares * (0.5 * (n - 1) - j);
    EXPECT_NEAR(result.trajectory.u[static_cast<std::size_t>(j)][0], expected, 1e-7);
  }
}

TEST(DoubleIntegrator, ScaleOfTheObjectiveDoesNotMoveTheOptimum) {
  const double h = 0.1;
  const ControlCase at = rest_to_rest(10, h, 100.0);
  std::vector<double> first_forces;
  for (const double scale : {1.0, 1e-14, 1e8}) {
    const std::vector<WeightedObjective> effort{{1.0, Effort{.factors = {scale}}}};
    const SolveResult result = solve(at.problem, effort, resting_guess(at.problem, h), {});
    ASSERT_EQ(result.status, SolveStatus::optimal) << result.sentence;
    first_forces.push_back(result.trajectory.u[0][0]);
  }
  EXPECT_NEAR(first_forces[1], first_forces[0], 1e-7);
  EXPECT_NEAR(first_forces[2], first_forces[0], 1e-7);
}

TEST(MinimumTime, IsThatOfTheDiscreteClosedForm) {
  // Full force one half of the time, full brake the other: with sum |c_j| = N^2/4 for even N the duration is the
  // continuous one, 2 sqrt(m d/U); for odd N, sum |c_j| = (N^2 - 1)/4.
  const double bound = 3.0;
  for (const int n : {10, 11}) {
    ControlCase at = rest_to_rest(n, 0.05, bound);
    at.problem.horizon.longest_step = 1.0;
    const std::vector<WeightedObjective> time{{1.0, FinalTime{}}};
    const SolveResult result = solve(at.problem, time, resting_guess(at.problem, 0.5), {});
    ASSERT_EQ(result.status, SolveStatus::optimal) << result.sentence;
    const double continuous = 2.0 * std::sqrt(mass * distance / bound);
    const double expected = n % 2 == 0 ? continuous : continuous * n / std::sqrt(n * n - 1.0);
    EXPECT_NEAR(result.objective, expected, 1e-7 * expected) << n;
    EXPECT_NEAR(n * result.trajectory.step, expected, 1e-7 * expected) << n;
  }
}

TEST(Order, OptimumOfHalvedStepsConvergesAtSecondOrder) {
  // A pendulum swings by a torque from rest to rest; h sum u^2 is the integral of the squared torque.
  std::vector<double> integrals;
  for (const int n : {10, 20, 40}) {
    test::RigidSystem system = test::pendulum();
    system.joint_forces.push_back({.joint = 0, .damping = 300.0, .control = 0});
    system.controls.push_back({.name = "torque", .unit = base::dimension::torque, .function = 0.0});
    ControlCase at(system);
    const double h = 500.0 / n;
    at.set_horizon(n, h);
    at.problem.controls = {{.control = 0, .reference = 10.0}};
    at.problem.initial.coordinates = {{.name = "joints.hinge", .rate = 0, .value = -90.0 * test::degree}};
    at.problem.final.coordinates = {{.name = "joints.hinge", .rate = 0, .value = -30.0 * test::degree}};
    const std::vector<WeightedObjective> effort{{h, Effort{.factors = {1.0}}}};
    const SolveResult result = solve(at.problem, effort, resting_guess(at.problem, h), {.tolerance = 1e-10});
    ASSERT_EQ(result.status, SolveStatus::optimal) << result.sentence;
    integrals.push_back(result.objective);
  }
  const double order = std::log2((integrals[0] - integrals[1]) / (integrals[1] - integrals[2]));
  EXPECT_NEAR(order, 2.0, 0.1) << integrals[0] << ' ' << integrals[1] << ' ' << integrals[2];
}

}  // namespace
}  // namespace muldi::control
