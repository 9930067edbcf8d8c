/// Optimal control: reference-results B, closed forms of the discrete problems, replays.
#include <gtest/gtest.h>

#include <cmath>

#include "base/text.hpp"
#include "optimal_run.hpp"
#include "pipeline/initial_state.hpp"
#include "pipeline/optimal_guess.hpp"
#include "pipeline/optimal_problem.hpp"

namespace muldi::golden {
namespace {

const std::string no_replay = "optimal_control.replay={}";

TEST(RevoluteJointOptimal, HasTheEffortOfTheReference) {
  const OptimalRun run("revolute_joint_optimal", {no_replay});
  ASSERT_TRUE(run.completed()) << run.found().outcome.sentence;
  EXPECT_NEAR(run.last().sum_squared_field, 5763.8653, 1e-6 * 5763.8653);  // independent program
  // The objective is the published one: 1e-14 of the squared voltage over 100 mm, in V.
  EXPECT_NEAR(run.objective(), 1e-14 * 1e10 * run.last().sum_squared_field, 1e-12 * run.objective());
  EXPECT_NEAR(run.final_value("joints/hinge/coordinate") / degree, 7.73, 1e-9);
}

TEST(RevoluteJointOptimal, HasTheEffortOfTheReferenceInTheFastMotion) {
  const OptimalRun run("revolute_joint_optimal",
                       {"optimal_control.duration=70 ms", "optimal_control.step=5 ms", no_replay});
  ASSERT_TRUE(run.completed()) << run.found().outcome.sentence;
  EXPECT_NEAR(run.last().sum_squared_field, 11493.9116, 1e-6 * 11493.9116);  // independent program
}

TEST(RevoluteJointOptimal, IsTheSameFromTwentyRandomGuesses) {
  const OptimalRun run("revolute_joint_optimal", {"optimal_control.guess={random: {starts: 20, seed: 1}}", no_replay});
  ASSERT_TRUE(run.completed()) << run.found().outcome.sentence;
  int n_starts = 0;
  for (const results::FixedArray& array : run.recorder().late_fixed()) {
    if (array.spec.path != "optimum/starts/sum_squared_field") continue;
    for (const double sum : array.reals) {
      ++n_starts;
      EXPECT_NEAR(sum, 5763.8653, 1e-6 * 5763.8653);
    }
  }
  EXPECT_EQ(n_starts, 20);
}

TEST(RevoluteJointOptimal, StaysAtAnEquilibriumOfTheHeldFields) {
  const OptimalRun run("revolute_joint_optimal",
                       {"optimal_control.final={momentum: rest, equilibrium: {agonist: 30 kV/mm, antagonist: 0}}",
                        "optimal_control.replay.step=10 ms"});
  ASSERT_TRUE(run.completed()) << run.found().outcome.sentence;
  EXPECT_NEAR(run.final_value("joints/hinge/coordinate") / degree, 7.7284947404, 1e-8);  // independent program
  EXPECT_LT(run.largest_afterwards(), 1e-8);                                             // mm and rad
}

TEST(RevoluteJointOptimal, WithFixedControlsIsTheForwardSimulation) {
  const OptimalRun run("revolute_joint_optimal",
                       {"optimal_control.controls={agonist: {min: 30 kV/mm, max: 30 kV/mm}, antagonist: {min: 5 kV/mm, "
                        "max: 5 kV/mm}}",
                        "optimal_control.final={momentum: free}",
                        "optimal_control.stages=[{minimise: {feasibility: 1}, tolerance: 1e-11}]", no_replay});
  ASSERT_TRUE(run.completed()) << run.found().outcome.sentence;
  EXPECT_LT(run.largest_deviation(), 1e-9);
}

TEST(ElephantTrunkOptimal, IsNotAboveTheReferenceOnThePublishedPath) {
  const OptimalRun run("elephant_trunk_optimal");
  ASSERT_TRUE(run.completed()) << run.found().outcome.sentence;
  EXPECT_LE(run.last().sum_squared_field, 118509.4763 * (1.0 + 1e-7));
  EXPECT_GE(run.last().sum_squared_field, 118410.1023 * (1.0 - 1e-7));  // the best that is known
  bool at_upper = false;
  for (const control::ActiveBound& bound : run.last().result.active) at_upper |= bound.upper;
  EXPECT_TRUE(at_upper) << "fields reach 40 kV/mm, as published";
}

TEST(DoubleIntegratorOptimal, IsTheDiscreteOptimum) {
  const OptimalRun run("double_integrator_optimal");
  ASSERT_TRUE(run.completed()) << run.found().outcome.sentence;
  const double m = 1000, length = 100, dt = 50, n = 20;
  const double lambda = 12 * m * length / (dt * dt * n * (n * n - 1));
  EXPECT_NEAR(run.objective(), 12 * m * m * length * length / (std::pow(dt, 4) * n * (n * n - 1)), 1e-9);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_NEAR(run.control("push", i), lambda * (n / 2 - static_cast<double>(i) - 0.5), 1e-7) << i;
  }
}

TEST(MinTimeSlider, TakesTheShortestTime) {
  const OptimalRun run("min_time_slider");
  ASSERT_TRUE(run.completed()) << run.found().outcome.sentence;
  EXPECT_NEAR(run.objective(), 2.0 * std::sqrt(1000.0 * 100.0 / 0.5), 1e-4);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_NEAR(run.control("push", i), i < 10 ? 0.5 : -0.5, 1e-4) << i;
}

TEST(DoubleIntegratorOptimal, BeyondItsForceIsInfeasible) {
  // Full force for half a second moves the mass by 0.05 N/1000 g (1 s)^2/4 = 12.5 mm of the 100 mm.
  const OptimalRun run("double_integrator_optimal", {"optimal_control.controls.push={min: -0.05, max: 0.05}"});
  EXPECT_EQ(variational::name_of(run.found().outcome.status), "infeasible");
  EXPECT_FALSE(run.last().result.worst_constraint.empty());
}

/// What the solver's own checker says of the first iterate of a scene's last stage.
control::SolveResult checked_by_the_solver(const std::string& name, const Overrides& overrides) {
  const scene::Scene scene = shipped(name, overrides);
  const build::BuiltModel built = build::build_model(scene);
  variational::State start;
  EXPECT_TRUE(pipeline::initial_state(scene, built, {}, start).completed());
  const pipeline::OptimalProblem problem = pipeline::build_optimal_problem(scene, built, start.x);
  return control::solve(problem.problem, problem.stages.back(), pipeline::make_guess(scene, built, problem.problem, 0),
                        {.max_iterations = 1, .check_derivatives = true});
}

struct CheckedScene {
  std::string name;
  Overrides overrides = {};
};
class SolversOwnCheck : public testing::TestWithParam<CheckedScene> {};

TEST_P(SolversOwnCheck, FindsNoWrongDerivative) {
  const control::SolveResult result = checked_by_the_solver(GetParam().name, GetParam().overrides);
  EXPECT_EQ(result.derivative_errors, 0) << result.derivative_log;
}

INSTANTIATE_TEST_SUITE_P(Scenes, SolversOwnCheck,
                         testing::Values(CheckedScene{"revolute_joint_optimal"},
                                         CheckedScene{"elephant_trunk_optimal", {"optimal_control.duration=100 ms"}},
                                         CheckedScene{"double_integrator_optimal"}, CheckedScene{"min_time_slider"},
                                         CheckedScene{"pendulum_swing_up", {"optimal_control.duration=500 ms"}},
                                         CheckedScene{"crane_rest_to_rest", {"optimal_control.duration=500 ms"}},
                                         CheckedScene{"four_bar_optimal", {"optimal_control.duration=100 ms"}}),
                         [](const auto& one) { return one.param.name; });

class Replay : public testing::TestWithParam<std::string> {};

TEST_P(Replay, AtTheSameStepIsTheOptimum) {
  const OptimalRun run(GetParam(), {"optimal_control.replay={}"});
  ASSERT_TRUE(run.completed()) << run.found().outcome.sentence;
  for (const pipeline::Deviation& one : run.found().replay->all) {
    EXPECT_LT(one.largest, one.is_angle ? 1e-9 : 1e-6) << one.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Replay,
                         testing::Values("revolute_joint_optimal", "double_integrator_optimal", "min_time_slider",
                                         "pendulum_swing_up", "crane_rest_to_rest", "four_bar_optimal"));

}  // namespace
}  // namespace muldi::golden
