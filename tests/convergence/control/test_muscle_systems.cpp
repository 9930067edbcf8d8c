/// The published problems of the thesis against an independent program (reference results, B).
#include <gtest/gtest.h>

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

TEST(Trunk, EffortAfterFeasibilityIsThePublishedOptimumOrABetterOne) {
  const ControlCase at = test::trunk_case();
  const SolveResult motion = solved(at, test::feasibility(), resting_guess(at.problem, 25.0));
  const SolveResult result = solved(at, test::effort_of_fields(12), motion.trajectory);
  EXPECT_LT(result.objective, 118509.4763 * (1.0 + 1e-6));
  for (const SolveResult* run : {&motion, &result}) {
    RecordProperty("iterations", run->iterations);
    std::printf(
        "trunk: %d variables, %d iterations, total %.3f s, functions %.3f s, Hessian %.3f s, set-up %.3f s, %.6f\n",
        run->n_variables, run->iterations, run->times.total, run->times.functions, run->times.hessian,
        run->times.transcription, run->objective);
  }
}

}  // namespace
}  // namespace muldi::control
