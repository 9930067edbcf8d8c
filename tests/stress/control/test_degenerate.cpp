/// Optimal control at its edges: guesses without field, scales of the objective, finer steps of the replay (numerics
/// C11, 5 nos. 25, 26).
#include <gtest/gtest.h>

#include <cmath>

#include "support/control_problems.hpp"
#include "support/figure.hpp"

namespace muldi::control {
namespace {

using test::ControlCase;

TEST(Degenerate, AGuessWithoutFieldIsBlindForFieldsButNotForTheirSquares) {
  // Muscle forces depend on E^2: at E = 0 every derivative by E is zero (numerics C11).
  ControlCase squared = test::joint_case(20, 10.0);
  const Trajectory guess = resting_guess(squared.problem, 10.0);
  for (const auto& u : guess.u) {
    for (const double value : u) ASSERT_EQ(value, 0.0);
  }
  const SolveResult found = solve(squared.problem, test::effort_of_fields(2), guess, {});
  EXPECT_EQ(found.status, SolveStatus::optimal) << found.sentence;
  // Independent program, reference results B.
  test::record_near("26", "muscle joint from a guess without field, by squares: effort", found.objective, 5763.8653,
                    1e-3);

  ControlCase plain = test::joint_case(20, 10.0);
  for (ControlChoice& choice : plain.problem.controls) {
    choice.kind = ControlKind::plain;
    choice.lower = -choice.upper;  // zero lies inside: from a bound at zero the solver would start beside it
  }
  const SolveResult blind = solve(plain.problem, test::effort_of_fields(2), guess, {.max_iterations = 200});
  EXPECT_EQ(blind.status, SolveStatus::infeasible) << "documented: the solver finds no way to go";
  test::record_at_least("26", "muscle joint from a guess without field, by the fields themselves: violation left",
                        blind.worst_violation, 1e-3);
}

TEST(Degenerate, TheOptimumOfMusclesDoesNotDependOnTheScaleOfTheObjective) {
  const ControlCase at = test::joint_case(10, 20.0);
  double expected = 0.0;
  for (const double scale : {1.0, 1e-4, 1e-9, 1e-14}) {
    const std::vector<WeightedObjective> effort{{scale, Effort{.factors = {1e-6, 1e-6}}}};
    const SolveResult result = solve(at.problem, effort, resting_guess(at.problem, 20.0), {});
    ASSERT_EQ(result.status, SolveStatus::optimal) << result.sentence;
    const double found = test::sum_of_squares(result.trajectory);
    if (scale == 1.0) expected = found;
    test::record_figure("26", "effort of an objective scaled by 1e-4 to 1e-14, relative difference",
                        std::abs(found / expected - 1.0), 1e-6);
  }
}

TEST(Degenerate, AReplayWithAQuarterOfTheStepDiffersByTheSquareOfTheStep) {
  const ControlCase at = test::joint_case(20, 10.0);
  const SolveResult result = solve(at.problem, test::effort_of_fields(2), resting_guess(at.problem, 10.0), {});
  ASSERT_EQ(result.status, SolveStatus::optimal) << result.sentence;
  /// Angle at the end of the optimal controls, each held over `factor` steps.
  const auto end = [&](int factor) {
    const ControlCase fine = test::joint_case(20 * factor, 10.0 / factor);
    std::vector<std::vector<double>> u;
    u.reserve(20 * static_cast<std::size_t>(factor));
    for (const auto& held : result.trajectory.u) u.insert(u.end(), static_cast<std::size_t>(factor), held);
    return simulate_guess(fine.problem, 10.0 / factor, u).x.back()[0];
  };
  const double angles[] = {end(1), end(2), end(4), end(8)};
  const double coarse = angles[0] - angles[2];
  const double fine = angles[1] - angles[3];
  test::record_figure("25", "optimum against a replay with dt/4, angle at the end (rad)", std::abs(coarse), 1e-2);
  test::record_near("25", "optimum against a replay with dt/4, ratio on halving", coarse / fine, 4.0, 0.4);
}

}  // namespace
}  // namespace muldi::control
