/// What a solve reports.
#include <gtest/gtest.h>

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
