/// What a solve reports.
#include <gtest/gtest.h>

#include <cmath>

#include <algorithm>

#include "support/control_problems.hpp"

namespace muldi::control {
namespace {

using test::ControlCase;

TEST(Solve, DerivativeCheckOfIpoptIsClean) {
  const ControlCase at = test::joint_case(3, 10.0);
  Trajectory guess = resting_guess(at.problem, 10.0);
  for (auto& u : guess.u) u = {2e4, 1e4};
  const SolveResult result =
      solve(at.problem, test::effort_of_fields(2), guess, {.max_iterations = 1, .check_derivatives = true});
  EXPECT_EQ(result.derivative_errors, 0) << result.derivative_log;
}

TEST(Solve, TellsTheUserWhatIsInfeasible) {
  // 7.73 degrees from rest to rest in two steps of 5 ms need more than 50 kV/mm.
  const ControlCase at = test::joint_case(2, 5.0);
  const SolveResult result = solve(at.problem, test::feasibility(), resting_guess(at.problem, 5.0), {});
  EXPECT_EQ(result.status, SolveStatus::infeasible) << result.sentence;
  EXPECT_FALSE(result.worst_constraint.empty());
  EXPECT_GT(result.worst_violation, 1e-3);
}

TEST(Solve, ReportsIteratesAndStopsOnRequest) {
  const ControlCase at = test::joint_case(20, 10.0);
  std::vector<Iterate> iterates;
  SolveOptions options{.progress = [&](const Iterate& iterate) { iterates.push_back(iterate); }};
  options.interrupted = [&] { return iterates.size() >= 4; };
  const SolveResult result = solve(at.problem, test::effort_of_fields(2), resting_guess(at.problem, 10.0), options);
  EXPECT_EQ(result.status, SolveStatus::interrupted);
  EXPECT_EQ(result.sentence, "interrupted; the best iterate so far is kept");
  ASSERT_EQ(iterates.size(), 4u);
  EXPECT_EQ(iterates[3].iteration, 3);
  double least = iterates[0].infeasibility;
  for (const Iterate& iterate : iterates) least = std::min(least, iterate.infeasibility);
  EXPECT_LE(result.infeasibility, least * (1.0 + 1e-12));
}

TEST(Solve, KeepsTheBestIterateAtTheLimit) {
  const ControlCase at = test::joint_case(20, 10.0);
  const SolveResult result =
      solve(at.problem, test::effort_of_fields(2), resting_guess(at.problem, 10.0), {.max_iterations = 3});
  EXPECT_EQ(result.status, SolveStatus::iteration_limit);
  EXPECT_EQ(result.trajectory.x.size(), 21u);
}

TEST(Solve, NamesActiveBounds) {
  // The fast rest-to-rest motion needs the largest field.
  const ControlCase at = test::joint_case(14, 5.0);
  const SolveResult result = solve(at.problem, test::effort_of_fields(2), resting_guess(at.problem, 5.0), {});
  const auto is_upper = [](const ActiveBound& bound) { return bound.name == "upper" && bound.upper; };
  EXPECT_TRUE(std::any_of(result.active.begin(), result.active.end(), is_upper));
}

/// Stretch of the upper muscle of reference results B, (-10, 15) to (90, 15) where the joint is at 0.
double stretch_at(double angle) {
  const double x = 90.0 * std::cos(angle) - 15.0 * std::sin(angle) + 10.0;
  const double y = 90.0 * std::sin(angle) + 15.0 * std::cos(angle) - 15.0;
  return std::hypot(x, y) / 100.0;
}

TEST(Solve, KeepsLimitsOfFieldsAndOfStabilityAndNamesThem) {
  constexpr double mu = 0.7 / 3.0;
  constexpr double permittivity = 3.1 * 8.8542e-12;
  for (const bool is_margin : {false, true}) {
    ControlCase at = test::joint_case(20, 10.0);
    if (is_margin) {
      at.problem.limits.pull_in_margin = 0.8;
    } else {
      at.problem.limits.true_field = 4e4;
    }
    const SolveResult result = solve(at.problem, test::effort_of_fields(2), resting_guess(at.problem, 10.0), {});
    ASSERT_EQ(result.status, SolveStatus::optimal) << result.sentence;
    // Under the bounds alone the sum is 5763.8653 and the field reaches 50 kV/mm.
    EXPECT_GT(test::sum_of_squares(result.trajectory), 5770.0);
    double extreme = is_margin ? 1.0 : 0.0;
    for (std::size_t k = 0; k < 20; ++k) {
      for (const std::size_t node : {k, k + 1}) {
        const double stretch = stretch_at(result.trajectory.x[node][0]);
        const double field = result.trajectory.u[k][0];
        // Pi''(stretch, E)/Pi''(1, 0) of numerics 1.10.
        const double margin =
            (mu * (1.0 + 2.0 / std::pow(stretch, 3)) - 3.0 * permittivity * field * field / std::pow(stretch, 4)) /
            (3.0 * mu);
        extreme = is_margin ? std::min(extreme, margin) : std::max(extreme, field / stretch);
      }
    }
    EXPECT_NEAR(extreme, is_margin ? 0.8 : 4e4, is_margin ? 1e-6 : 0.1);
    const std::string wanted =
        is_margin ? "limits.pull_in_margin of muscles/upper" : "limits.true_field of muscles/upper";
    const auto is_wanted = [&](const ActiveBound& bound) { return bound.name == wanted && bound.upper != is_margin; };
    EXPECT_TRUE(std::any_of(result.active.begin(), result.active.end(), is_wanted));
  }
}

TEST(Solve, FindsTheExactEquilibriumThatIsAskedFor) {
  // Reference results A: 7.7284947404 degrees under 30 kV/mm.
  ControlCase at = test::joint_case(20, 10.0);
  at.problem.final.coordinates.clear();
  at.problem.final.equilibrium = {3e4, 0.0};
  const SolveResult result = solve(at.problem, test::effort_of_fields(2), resting_guess(at.problem, 10.0), {});
  ASSERT_EQ(result.status, SolveStatus::optimal) << result.sentence;
  EXPECT_NEAR(result.trajectory.x[20][0] / test::degree, 7.7284947404, 1e-7);
}

}  // namespace
}  // namespace muldi::control
