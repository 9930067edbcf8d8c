/// Optimal control: reference-results B, closed forms of the discrete problems, replays.
#include <gtest/gtest.h>

#include <algorithm>
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
    EXPECT_LT(one.largest, one.is_angle ? 1e-9 : 1e-7) << one.name;  // mm, in scenes of 100 mm and more
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Replay,
                         testing::Values("revolute_joint_optimal", "elephant_trunk_optimal",
                                         "double_integrator_optimal", "min_time_slider", "pendulum_swing_up",
                                         "crane_rest_to_rest", "four_bar_optimal"));

/// The same pose at the end, said in other words, some of them redundant: 7.73 degrees about the origin.
std::vector<std::string> equal_conditions() {
  const double c = std::cos(7.73 * degree);
  const double s = std::sin(7.73 * degree);
  const std::string turned = "{axis: [0, 0, 1], angle: 7.73 deg}";
  const std::string point = base::format("[{:.15g}, {:.15g}, ", 90.0 * c - 15.0 * s, 90.0 * s + 15.0 * c);
  const std::string other = base::format("[{:.15g}, {:.15g}, ", 90.0 * c + 15.0 * s, 90.0 * s - 15.0 * c);
  const std::string centre = base::format("[{:.15g}, {:.15g}, 0]", 46.0 * c, 46.0 * s);
  return {"orientations: {pendulum: " + turned + "}",
          "bodies: {pendulum: {position: " + centre + ", orientation: " + turned + "}}",
          "points: {pendulum.upper: " + point + "~]}",
          "points: {pendulum.upper: " + point + "0], pendulum.lower: " + other + "0]}, joints: {hinge: 7.73 deg}"};
}

TEST(RevoluteJointOptimal, IsTheSameHoweverItsEndIsSaid) {
  for (const std::string& condition : equal_conditions()) {
    const OptimalRun run("revolute_joint_optimal",
                         {"optimal_control.final={" + condition + ", momentum: rest}", no_replay});
    ASSERT_TRUE(run.completed()) << condition << '\n' << run.found().outcome.sentence;
    EXPECT_NEAR(run.last().sum_squared_field, 5763.8653, 1e-6 * 5763.8653) << condition;
  }
}

TEST(RevoluteJointOptimal, PeakFieldIsTheLeastThatAnyMotionNeeds) {
  const OptimalRun least("revolute_joint_optimal", {"optimal_control.stages=[{minimise: {peak_field: 1}}]", no_replay});
  ASSERT_TRUE(least.completed()) << least.found().outcome.sentence;
  const double peak = std::sqrt(least.objective());  // kV/mm
  double largest = 0.0;
  for (std::size_t n = 0; n < 20; ++n) {
    largest = std::max({largest, least.control("agonist", n), least.control("antagonist", n)});
  }
  EXPECT_NEAR(1e-3 * largest, peak, 1e-4 * peak);
  // With a little less as the bound of both fields there is no motion, with a little more there is.
  for (const double factor : {0.99, 1.01}) {
    const std::string bounds = base::format("{{min: 0, max: {:.15g} kV/mm}}", factor * peak);
    const OptimalRun run("revolute_joint_optimal",
                         {"optimal_control.controls={agonist: " + bounds + ", antagonist: " + bounds + "}",
                          "optimal_control.stages=[{minimise: {feasibility: 1}}]", no_replay});
    EXPECT_EQ(run.completed(), factor > 1.0) << factor;
  }
}

bool is_active(const OptimalRun& run, const std::string& name) {
  for (const control::ActiveBound& bound : run.last().result.active) {
    if (bound.name == name) return true;
  }
  return false;
}

TEST(CraneRestToRest, KeepsItsLimitsAndNamesThem) {
  const OptimalRun angle("crane_rest_to_rest", {no_replay});
  ASSERT_TRUE(angle.completed()) << angle.found().outcome.sentence;
  EXPECT_TRUE(is_active(angle, "limits.joints.hook"));
  for (const double swing : angle.recorder().reals("joints/hook/coordinate"))
    EXPECT_LT(std::abs(swing), 6.0 * degree + 1e-7);
  // The same as a box for the load, which rises by 1 m (1 - cos 6 degrees).
  const OptimalRun box("crane_rest_to_rest",
                       {base::format("optimal_control.limits={{points: {{load.centre: [[~, ~, ~], [~, {:.15g}, ~]]}}}}",
                                     -1000.0 * std::cos(6.0 * degree)),
                        no_replay});
  ASSERT_TRUE(box.completed()) << box.found().outcome.sentence;
  EXPECT_TRUE(is_active(box, "limits.points.load.centre"));
  EXPECT_NEAR(box.objective(), angle.objective(), 1e-6 * angle.objective());
}

TEST(FeReplay, TableHoldsTheDistancesBetweenItsRowsAndTheOptimum) {
  // Coarse muscles: what is compared counts, not how well they agree.
  const OptimalRun run("revolute_joint_optimal",
                       {"muscles.upper.fe.layers=3", "muscles.lower.fe.layers=3", "record.every=1",
                        "optimal_control.replay={step: 5 ms, muscles: fe, then: {duration: 20 "
                        "ms, controls: {agonist: 30 kV/mm, antagonist: 0}}}"});
  ASSERT_TRUE(run.completed()) << run.found().outcome.sentence;
  const std::span<const double> optimum = run.recorder().reals("joints/hinge/coordinate");
  const std::span<const double> replay = run.recorder().reals("replay/joints/hinge/coordinate");
  ASSERT_EQ(optimum.size(), 21u);
  ASSERT_EQ(replay.size(), 45u);
  const pipeline::Deviation& hinge = run.found().replay->all.at(0);
  EXPECT_EQ(hinge.name, "joints/hinge");
  ASSERT_EQ(hinge.values.size(), 21u);
  double largest = 0.0;
  for (std::size_t n = 0; n < 21; ++n) {
    EXPECT_NEAR(hinge.values[n], replay[2 * n] - optimum[n], 1e-12) << n;
    largest = std::max(largest, std::abs(replay[2 * n] - optimum[n]));
  }
  double after = 0.0;
  for (std::size_t n = 41; n < 45; ++n) after = std::max(after, std::abs(replay[n] - optimum[20]));
  EXPECT_GT(largest, 1e-3);  // other muscles move otherwise
  EXPECT_NEAR(hinge.largest, largest, 1e-12);
  EXPECT_NEAR(hinge.final, std::abs(replay[40] - optimum[20]), 1e-12);
  EXPECT_NEAR(hinge.after, after, 1e-12);
}

TEST(FourBarOptimal, IsDrivenAtTheJointThatClosesTheLoop) {
  // A spring, a damper and half of the drive on the joint that is cut: the replay is the optimum, so its forces are
  // right.
  const OptimalRun run("four_bar_optimal",
                       {"joints.D.stiffness=20", "joints.D.damping=100", "joints.D.torque={control: drive}"});
  ASSERT_TRUE(run.completed()) << run.found().outcome.sentence;
  EXPECT_LT(run.largest_deviation(), 1e-6);
}

TEST(FourBarOptimal, TakesTheCoordinateOfTheJointThatClosesTheLoopAsThatOfAnyOther) {
  const OptimalRun crank("four_bar_optimal", {no_replay});
  ASSERT_TRUE(crank.completed()) << crank.found().outcome.sentence;
  const std::span<const double> rocker = crank.recorder().reals("joints/D/coordinate");
  const double end = rocker.back();
  const OptimalRun same("four_bar_optimal",
                        {base::format("optimal_control.final.joints={{D: {:.17g}}}", end), no_replay});
  ASSERT_TRUE(same.completed()) << same.found().outcome.sentence;
  EXPECT_NEAR(same.objective(), crank.objective(), 1e-8 * crank.objective());
  EXPECT_NEAR(same.recorder().reals("joints/A/coordinate").back(), 90.0 * degree, 1e-9);
  // The effort may also be left to a squared distance, of which the target is the least value.
  const OptimalRun near("four_bar_optimal", {"optimal_control.final.joints={}",
                                             base::format("optimal_control.stages=[{{minimise: {{terminal: {{joints: "
                                                          "{{D: {:.17g}}}}}}}}}]",
                                                          end),
                                             no_replay});
  ASSERT_TRUE(near.completed()) << near.found().outcome.sentence;
  EXPECT_NEAR(near.recorder().reals("joints/D/coordinate").back(), end, 1e-6);
}

TEST(FourBarOptimal, KeepsALimitOfTheJointThatClosesTheLoop) {
  const OptimalRun free("four_bar_optimal", {no_replay});
  ASSERT_TRUE(free.completed()) << free.found().outcome.sentence;
  const std::span<const double> rocker = free.recorder().reals("joints/D/coordinate");
  const double least = *std::ranges::min_element(rocker);
  const double most = *std::ranges::max_element(rocker);
  // A range that the motion just fits changes nothing; inside it the motion stays where it is narrower.
  const auto limited = [&](double lower, double upper) {
    return OptimalRun("four_bar_optimal",
                      {base::format("optimal_control.limits={{joints: {{D: [{:.15g}, {:.15g}]}}}}", lower, upper),
                       "optimal_control.final.joints={}",
                       "optimal_control.stages=[{minimise: {terminal: {joints: {A: 90 deg}}}}]", no_replay});
  };
  const OptimalRun wide = limited(least - 0.01, most + 0.01);
  ASSERT_TRUE(wide.completed()) << wide.found().outcome.sentence;
  EXPECT_LT(wide.objective(), 1e-8);
  const double middle = 0.5 * (least + most);
  const bool falls = rocker.back() < rocker.front();
  const OptimalRun narrow = falls ? limited(middle, most + 0.01) : limited(least - 0.01, middle);
  ASSERT_TRUE(narrow.completed()) << narrow.found().outcome.sentence;
  EXPECT_TRUE(is_active(narrow, "limits.joints.D"));
  EXPECT_NEAR(narrow.recorder().reals("joints/D/coordinate").back(), middle, 1e-6);
}

}  // namespace
}  // namespace muldi::golden
