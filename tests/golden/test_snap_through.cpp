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

TEST(RevoluteJointSnapThrough, LimitPointIsTheSameAlongTheOtherControl) {
  // Where the stiffness is singular does not depend on which of the two fields led there.
  const SceneRun run("revolute_joint_snap_through",
                     {"controls.agonist.field=17655.306 V/mm",
                      "statics={control: antagonist, from: 18 kV/mm, to: 16.5 kV/mm, steps: 6, continuation: "
                      "arc_length}"});
  EXPECT_NEAR(run.attribute("statics", "limit_load"), 17000.0, 1e-3);
}

/// The lumped joint of revolute_joint_twin: ends of its muscles at (-10, +-15) and, turned by the angle, (90, +-15).
struct ClosedFormTwin {
  static double length(double angle, double side) {
    return std::hypot(90.0 * std::cos(angle) - side * 15.0 * std::sin(angle) + 10.0,
                      90.0 * std::sin(angle) + side * 15.0 * (std::cos(angle) - 1.0));
  }
  /// d length/d angle: the lever of the line between the ends about the hinge.
  static double lever(double angle, double side) {
    return -(675.0 * std::sin(angle) + side * 1500.0 * std::cos(angle)) / length(angle, side);
  }
  /// The field of the upper muscle in equilibrium: mu (L - 1/L^2) + eps E^2/L^3 and mu (l - 1/l^2) balance.
  static double field(double angle) {
    const double mu = 0.7 / 3.0, eps = 3.1 * 8.8542e-12;
    const double up = length(angle, 1.0) / 100.0, low = length(angle, -1.0) / 100.0;
    const auto passive = [&](double stretch) { return mu * (stretch - 1.0 / (stretch * stretch)); };
    const double ratio = lever(angle, -1.0) / lever(angle, 1.0);
    return std::sqrt(-(passive(up) + passive(low) * ratio) * up * up * up / eps);
  }
};

TEST(RevoluteJointTwin, LumpedJointPassesItsLimitOnBothBranchesAsInClosedForm) {
  const SceneRun run("revolute_joint_twin",
                     {"muscles.upper.model=lumped", "muscles.lower.model=lumped", "dynamics.duration=1 ms",
                      "statics={control: agonist, to: 120 kV/mm, steps: 30, continuation: arc_length}"});
  const auto load = run.rows("statics/load"), angle = run.rows("statics/joints/hinge/coordinate");
  const auto stable = run.recorder().integers("statics/stable");
  double limit = 0.0, at = 0.0;
  for (double x = 1.2; x < 1.3; x += 1e-5) {
    if (ClosedFormTwin::field(x) > limit) limit = ClosedFormTwin::field(x), at = x;
  }
  EXPECT_NEAR(run.attribute("statics", "limit_load"), limit, 1e-5);  // 57410.307 V/mm at 71.79 degrees
  int beyond = 0;
  for (Eigen::Index k = 1; k < load.cols() && load(0, k) > 1e3; ++k) {
    EXPECT_NEAR(load(0, k), ClosedFormTwin::field(angle(0, k)), 1e-9 * load(0, k)) << angle(0, k);
    EXPECT_EQ(stable[static_cast<std::size_t>(k)] != 0, angle(0, k) < at) << angle(0, k);
    beyond += angle(0, k) > at ? 1 : 0;
  }
  EXPECT_GT(beyond, 20);
}

TEST(RevoluteJointTwin, MusclesThatInvertEndTheMotionWithItsLastState) {
  const SceneRun run("revolute_joint_twin",
                     {"muscles.upper.fe.layers=7", "muscles.lower.fe.layers=7",
                      "controls.agonist.field={ramp: {from: 0, to: 100 kV/mm, start: 0, over: 40 ms}}",
                      "dynamics={duration: 200 ms, step: 0.4 ms}", "record.every=1", "statics.steps=1"});
  EXPECT_EQ(run.outcome().status, variational::Status::inverted_element);
  EXPECT_EQ(run.outcome().sentence.find("solid 'upper': cell "), 0U) << run.outcome().sentence;
  EXPECT_NE(run.outcome().sentence.find(" is inverted (det F -"), std::string::npos) << run.outcome().sentence;
  const auto time = run.rows("time");
  // Not the step's doing: at 99.8 ms and 92.96 degrees with 0.2 and 0.1 ms (recorded).
  EXPECT_NEAR(time.rightCols<1>()[0], 99.8, 0.5);
  EXPECT_NEAR(run.value("joints/hinge/coordinate") / degree, 92.96, 1.0);
  EXPECT_EQ(run.n_rows("joints/hinge/coordinate"), static_cast<std::size_t>(time.cols()));
  EXPECT_TRUE(run.last("bodies/pendulum/position").allFinite());
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
