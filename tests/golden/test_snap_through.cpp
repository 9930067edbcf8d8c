/// Stability of the joint between two charged muscles (thesis 5.4.3): the critical field of its middle position, its
/// snap-through between tilted equilibria, and where it goes after a shock.
#include <gtest/gtest.h>

#include <cmath>

#include "scene_run.hpp"

namespace muldi::golden {
namespace {

const std::string natural = "statics.continuation=natural";
/// Number of changes from stable to unstable and back along the curve.
int changes_of_stability(const SceneRun& run) {
  const auto stable = run.recorder().integers("statics/stable");
  int changes = 0;
  for (std::size_t k = 1; k < stable.size(); ++k) changes += stable[k] != stable[k - 1] ? 1 : 0;
  return changes;
}

/// Load at which the recorded curve passes an angle, by linear interpolation.
double load_at(const SceneRun& run, double angle) {
  const auto load = run.rows("statics/load"), at = run.rows("statics/joints/hinge/coordinate");
  for (Eigen::Index k = 1; k < load.cols(); ++k) {
    const double before = at(0, k - 1) - angle, after = at(0, k) - angle;
    if (before * after <= 0.0) return load(0, k - 1) + (load(0, k) - load(0, k - 1)) * before / (before - after);
  }
  return std::nan("");
}

/// EXPECTs that load stepping lost its branch between loads that enclose `critical`, not far from it. Whether it finds
/// the other branch from there is up to Newton's iteration.
void expect_lost_at(const SceneRun& run, double critical) {
  const bool jumps = run.outcome().completed();
  const double before = run.attribute("statics", jumps ? "jump_load_before" : "critical_load_above");
  const double after = run.attribute("statics", jumps ? "jump_load_after" : "critical_load_below");
  EXPECT_LT((before - critical) * (after - critical), 0.0) << before << ' ' << after;
  EXPECT_LT(std::abs(after - before), 2e-6 * critical);
}

TEST(RevoluteJointSnapThrough, RecordsBothStableBranchesAndTheUnstableOneBetweenThem) {
  const SceneRun run("revolute_joint_snap_through", {"statics.steps=14"});
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  EXPECT_EQ(changes_of_stability(run), 2);
  const auto angle = run.rows("statics/joints/hinge/coordinate");
  const auto stable = run.recorder().integers("statics/stable");
  for (Eigen::Index k = 0; k < angle.cols(); ++k) {
    if (std::abs(angle(0, k)) > 0.35) continue;
    EXPECT_EQ(stable[static_cast<std::size_t>(k)], 0) << angle(0, k);
  }
  EXPECT_LT(angle(0, 0), -1.0);
  EXPECT_GT(angle(0, angle.cols() - 1), 1.0);
  // Equal fields hold the middle position, by symmetry.
  EXPECT_NEAR(load_at(run, 0.0), 17000.0, 2.0);  // between points of the curve it bends
}

TEST(RevoluteJointSnapThrough, LimitPointsAreWhereLoadStepsLoseTheirBranchFromEitherSide) {
  const SceneRun run("revolute_joint_snap_through", {"statics.steps=6"});
  const double up = run.attribute("statics", "limit_load"), down = run.attribute("statics", "limit_load_2");
  expect_lost_at(SceneRun("revolute_joint_snap_through",
                          {natural, "statics.steps=2", "statics.from=16 kV/mm", "statics.to=18 kV/mm"}),
                 up);
  expect_lost_at(SceneRun("revolute_joint_snap_through",
                          {natural, "statics.steps=2", "statics.from=18 kV/mm", "statics.to=16 kV/mm"}),
                 down);
  EXPECT_NEAR(up, 17655.306, 1e-3);    // recorded
  EXPECT_NEAR(down, 16556.060, 1e-3);  // recorded
}

const std::string both_swept = "statics={control: both, from: 10 kV/mm, to: 17 kV/mm, steps: 4, continuation: ";

TEST(RevoluteJointFe, MiddlePositionLosesItsStabilityAtACriticalField) {
  const std::string short_run = "dynamics.duration=1 ms";
  const SceneRun along("revolute_joint_fe_shock", {short_run, both_swept + "arc_length}"});
  ASSERT_TRUE(along.outcome().completed()) << along.outcome().sentence;
  const double critical = along.attribute("statics", "branch_load");
  EXPECT_NEAR(critical, 14889.376, 1e-2);  // recorded
  expect_lost_at(SceneRun("revolute_joint_fe_shock", {short_run, both_swept + "natural}"}), critical);
}

/// Angle in degrees a second after the shock.
double angle_after_shock(const std::string& field) {
  return SceneRun("revolute_joint_fe_shock", {"dynamics.duration=1 s", "controls.both.field=" + field})
             .value("joints/hinge/coordinate") /
         degree;
}

TEST(RevoluteJointFe, ShockBeyondTheCriticalFieldEndsInANewEquilibrium) {
  EXPECT_NEAR(angle_after_shock("14 kV/mm"), 0.0, 0.1);
  const SceneRun statics("revolute_joint_fe_shock", {"dynamics.duration=1 ms", both_swept + "natural}"});
  const double tilted = std::abs(statics.value("statics/joints/hinge/coordinate")) / degree;
  EXPECT_GT(tilted, 45.0);
  EXPECT_NEAR(angle_after_shock("17 kV/mm"), tilted, 0.1);
}

}  // namespace
}  // namespace muldi::golden
