/// Longer optimisations: the documented multistart of the trunk, replays on finite elements.
///
/// The published comparison of lumped optima with finite elements (thesis 8.3.1): the revolute joint's optimal fields
/// on muscles of 92 cells with the original parameters, while the lumped ones have theirs matched to the steady state.
#include <gtest/gtest.h>

#include "optimal_run.hpp"

namespace muldi::golden {
namespace {

struct Case {
  std::string name;
  std::string duration, step, interpolation;
  double published;  // largest difference of the angles, degrees
};

class PublishedReplay : public testing::TestWithParam<Case> {};

/// Which difference was printed, to the optimum or to a lumped replay, is not stated: ours to the optimum within the
/// horizon are 0.262, 0.887, 0.349 and 0.666 degrees, of two replays by the same fields 0.373, 0.329, 0.374 and 0.351.
TEST_P(PublishedReplay, DiffersFromTheOptimumByWithinTwiceThePublishedAngle) {
  const OptimalRun run(
      "revolute_joint_optimal",
      {"optimal_control.duration=" + GetParam().duration, "optimal_control.step=" + GetParam().step,
       "optimal_control.replay={step: 1 ms, muscles: fe, interpolation: " + GetParam().interpolation + "}"});
  ASSERT_TRUE(run.completed()) << run.found().outcome.sentence;
  const double largest = run.found().replay->all.at(0).largest / degree;
  RecordProperty("degrees", std::to_string(largest));
  EXPECT_LT(largest, 2.0 * GetParam().published);
  EXPECT_GT(largest, 0.5 * GetParam().published);
}

INSTANTIATE_TEST_SUITE_P(Motions, PublishedReplay,
                         testing::Values(Case{"slow_held", "200 ms", "10 ms", "steps", 0.50},
                                         Case{"slow_linear", "200 ms", "10 ms", "linear", 0.54},
                                         Case{"fast_held", "70 ms", "5 ms", "steps", 0.51},
                                         Case{"fast_linear", "70 ms", "5 ms", "linear", 0.62}),
                         [](const auto& one) { return one.param.name; });

TEST(ElephantTrunkOptimal, DocumentedMultistartFindsTheBetterOptimum) {
  const OptimalRun run("elephant_trunk_optimal", {"optimal_control.guess={random: {starts: 8, seed: 1}}",
                                                  "optimal_control.stages=[{minimise: {effort: {scale: 1.0e-14}}}]",
                                                  "optimal_control.replay={}"});
  ASSERT_TRUE(run.completed()) << run.found().outcome.sentence;
  EXPECT_NEAR(run.last().sum_squared_field, 118410.1023, 1e-7 * 118410.1023);  // independent program
}

TEST(ElephantTrunkOptimal, RunsOnFiniteElements) {
  // Thesis Fig. 8.10: unchanged parameters, 12 muscles of 288 cells, another steady state; the figure has no numbers.
  // The tip goes by 124.7 mm and ends 27.0 mm from its target (recorded). Steps of 5 ms and more do not converge at the
  // end.
  const OptimalRun run("elephant_trunk_optimal", {"optimal_control.replay={step: 2.5 ms, muscles: fe}"});
  ASSERT_TRUE(run.completed()) << run.found().outcome.sentence;
  const pipeline::Deviation& tip = run.found().replay->all.back();
  ASSERT_EQ(tip.name, "points/segment6.rho6");
  EXPECT_LT(tip.final, 0.3 * 124.7);
  EXPECT_GT(tip.final, 0.1 * 124.7);
}

}  // namespace
}  // namespace muldi::golden
