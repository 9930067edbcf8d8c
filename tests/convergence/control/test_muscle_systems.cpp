/// The published problems of the thesis against an independent program (reference results, B).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/control_problems.hpp"

namespace muldi::control {
namespace {

using test::ControlCase;

SolveResult solved(const ControlCase& at, const std::vector<WeightedObjective>& objectives, const Trajectory& guess) {
  SolveResult result = solve(at.problem, objectives, guess, {});
  EXPECT_EQ(result.status, SolveStatus::optimal) << result.sentence;
  return result;
}

TEST(MuscleJoint, EffortIsThatOfAnIndependentProgram) {
  const ControlCase at = test::joint_case(20, 10.0);
  const SolveResult result = solved(at, test::effort_of_fields(2), resting_guess(at.problem, 10.0));
  EXPECT_NEAR(result.objective, 5763.8653, 1e-4);
  EXPECT_NEAR(test::sum_of_squares(result.trajectory), 5763.8653, 1e-3);
}

TEST(MuscleJoint, FastEffortIsThatOfAnIndependentProgram) {
  const ControlCase at = test::joint_case(14, 5.0);
  const SolveResult result = solved(at, test::effort_of_fields(2), resting_guess(at.problem, 5.0));
  EXPECT_NEAR(result.objective, 11493.9116, 1e-4);
}

TEST(MuscleJoint, TwentyRandomGuessesGiveTheSameOptimum) {
  const ControlCase at = test::joint_case(20, 10.0);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> fields(0.0, 5e4);
  for (int i = 0; i < 20; ++i) {
    std::vector<std::vector<double>> u(20, std::vector<double>(2));
    for (auto& values : u) {
      for (double& value : values) value = fields(random);
    }
    const SolveResult result = solved(at, test::effort_of_fields(2), simulate_guess(at.problem, 10.0, u));
    EXPECT_NEAR(result.objective, 5763.8653, 1e-4) << "guess " << i;
  }
}

TEST(MuscleJoint, ForwardRunUnderTheOptimumAgreesAndStaysAtRestAfterTheHorizon) {
  // The target is an exact equilibrium of the fields held after the horizon.
  ControlCase at = test::joint_case(20, 10.0);
  at.problem.final.coordinates.clear();
  at.problem.final.equilibrium = {3e4, 0.0};
  const SolveResult result =
      solve(at.problem, test::effort_of_fields(2), resting_guess(at.problem, 10.0), {.tolerance = 1e-11});
  ASSERT_EQ(result.status, SolveStatus::optimal) << result.sentence;
  const Trajectory forward = simulate_guess(at.problem, 10.0, result.trajectory.u);
  EXPECT_LT(test::distance(*at.model, forward, result.trajectory), 1e-9);

  ControlCase longer = test::joint_case(40, 10.0);
  std::vector<std::vector<double>> u = result.trajectory.u;
  u.resize(40, {3e4, 0.0});
  const Trajectory held = simulate_guess(longer.problem, 10.0, u);
  for (std::size_t n = 20; n <= 40; ++n) EXPECT_NEAR(held.x[n][0], result.trajectory.x[20][0], 1e-8) << n;
}

TEST(Trunk, BetterOptimumIsFoundFromARandomMotion) {
  // Reference results B: 8 of 19 random starts end there.
  const ControlCase at = test::trunk_case();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> squares(0.0, 1.0);
  std::vector<std::vector<double>> u(40, std::vector<double>(12));
  for (auto& fields : u) {
    for (double& field : fields) field = 4e4 * std::sqrt(squares(random));
  }
  const SolveResult result = solved(at, test::effort_of_fields(12), simulate_guess(at.problem, 25.0, u));
  EXPECT_NEAR(result.objective, 118410.1023, 1e-3);
}

TEST(Trunk, EffortAfterFeasibilityIsThePublishedOptimumOrABetterOne) {
  const ControlCase at = test::trunk_case();
  const SolveResult motion = solved(at, test::feasibility(), resting_guess(at.problem, 25.0));
  const SolveResult result = solved(at, test::effort_of_fields(12), motion.trajectory);
  EXPECT_LT(result.objective, 118509.4763 * (1.0 + 1e-6));
  EXPECT_LE(motion.iterations + result.iterations, 100) << "the independent program took 109 from a cold guess";
  EXPECT_EQ(result.n_variables, 41 * 6 + 40 * 12);
}

}  // namespace
}  // namespace muldi::control
