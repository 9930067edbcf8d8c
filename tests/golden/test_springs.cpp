/// The weight on a cable: closed forms of the taut, the slack and the caught cable.
#include <gtest/gtest.h>

#include <algorithm>

#include "scene_run.hpp"

namespace muldi::golden {
namespace {

constexpr double g = 9.81e-3;
constexpr double m = 100.0;
constexpr double k = 0.1;
constexpr double rest_length = 100.0;
constexpr double transition = 1.0;

TEST(SlackCable, HangsAtItsClosedForm) {
  const SceneRun run("slack_cable", {"dynamics.duration=1 ms", "record.every=1"});
  EXPECT_NEAR(run.value("statics/springs/cable/length"), rest_length + m * g / k + 0.5 * transition, 1e-9);
  EXPECT_NEAR(run.value("statics/springs/cable/force"), m * g, 1e-10);
}

TEST(SlackCable, LetsTheWeightFlyFreelyAndCatchesIt) {
  const SceneRun run("slack_cable", {"record.every=1"});
  const Eigen::RowVectorXd length = run.rows("springs/cable/length").row(0);
  const Eigen::RowVectorXd force = run.rows("springs/cable/force").row(0);
  EXPECT_GE(force.minCoeff(), 0.0);  // it never pushes
  int n_free = 0;
  for (Eigen::Index i = 1; i + 1 < length.size(); ++i) {
    if (std::max({length[i - 1], length[i], length[i + 1]}) > rest_length) continue;
    ++n_free;
    EXPECT_EQ(force[i], 0.0);
    // The midpoint rule is exact in free flight; the rest is round-off of lengths near 100.
    EXPECT_NEAR(length[i + 1] - 2.0 * length[i] + length[i - 1], g, 1e-12);
  }
  // It is h = 5 below the taut length with speed 1 and leaves with v^2 <= 1 - 2 g h + k/m (h - w/2)^2 = 0.960^2, of
  // which the damper takes at most c h/m = 0.1; it flies for 2 v/g, of which a step at either end is not counted.
  EXPECT_GT(n_free, 172);
  EXPECT_LT(n_free, 196);
  // Caught, it comes to rest: oscillations of some 10 mm decay with exp(-c t/2m), 1e-5 in 1.2 s.
  EXPECT_NEAR(length[length.size() - 1], rest_length + m * g / k + 0.5 * transition, 1e-3);
}

}  // namespace
}  // namespace muldi::golden
