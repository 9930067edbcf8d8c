/// What is found before a solve.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/transcription.hpp"
#include "math/rotation.hpp"
#include "support/control_problems.hpp"
#include "support/linkages.hpp"

namespace muldi::control {
namespace {

using Eigen::Vector3d;
using test::ControlCase;

std::string text_of(const ControlCase& at) {
  std::string text;
  for (const Fault& fault : find_faults(at.problem, resting_guess(at.problem, at.step()))) {
    text += fault.where + ": " + fault.why + "\n";
  }
  return text;
}

TEST(Faults, NoneInAProperProblem) { EXPECT_EQ(text_of(test::joint_case(5, 10.0)), ""); }

TEST(Faults, NoControlIsSought) {
  ControlCase at = test::joint_case(5, 10.0);
  at.problem.controls.clear();
  EXPECT_EQ(text_of(at), "controls: no control is sought: name at least one\n");
}

TEST(Faults, CrossedBounds) {
  ControlCase at = test::joint_case(5, 10.0);
  at.problem.controls[1].lower = 6e4;
  at.problem.limits.coordinates.push_back({.name = "joints.hinge", .rate = 0, .lower = 1.0, .upper = -1.0});
  EXPECT_EQ(text_of(at),
            "limits.joints.hinge: the lower bound is above the upper one\n"
            "controls.lower: the lower bound is above the upper one\n");
}

TEST(Faults, NegativeBoundOfASquare) {
  ControlCase at = test::joint_case(5, 10.0);
  at.problem.controls[0].lower = -1e3;
  EXPECT_EQ(text_of(at), "controls.upper: only the square of this control acts: its bounds must not be negative\n");
}

TEST(Faults, TargetOutOfReach) {
  // The tip of the trunk is at most about 306 mm from its base.
  ControlCase at = test::trunk_case(5);
  at.problem.final.points[0].value = {0.0, 400.0, 0.0};
  const std::string text = text_of(at);
  EXPECT_THAT(text,
              testing::StartsWith("final.points.tip: cannot be reached: the nearest pose that was found misses it"))
      << text;
}

TEST(Faults, EquilibriumAtOddsWithACoordinate) {
  // 7.73 degrees is a rounded equilibrium: the exact one is 7.7284947404 degrees, 2.6271e-5 rad away.
  ControlCase at = test::joint_case(5, 10.0);
  at.problem.final.equilibrium = {3e4, 0.0};
  EXPECT_EQ(text_of(at),
            "final.equilibrium: is at odds with the other conditions of this end: there the joints would have to move "
            "on by about 2.627e-05\n");
}

TEST(Faults, MoreConditionsThanFreedoms) {
  // Two steps of two fields cannot fix pose and momentum of six joints.
  ControlCase at = test::trunk_case(2);
  for (int k = 0; k < 6; ++k) {
    at.problem.final.coordinates.push_back({.name = "joints.j", .rate = k, .value = 0.0});
  }
  at.problem.final.points.clear();
  at.problem.controls.resize(2);
  EXPECT_EQ(text_of(at),
            ": more conditions than freedoms: 18 equations for 10 unknowns; give more steps or controls, or fewer "
            "conditions\n");
}

TEST(Faults, FreeDurationWithAFunctionOfTime) {
  ControlCase at = test::joint_case(5, 10.0);
  at.model->controls[1].function = base::TimeFunction(base::TimeFunction::Kind(base::Ramp{.to = 1.0, .over = 5.0}));
  at.problem.controls.pop_back();
  at.problem.horizon.longest_step = 20.0;
  EXPECT_EQ(
      text_of(at),
      "controls: 'lower' is a function of time and is not sought, but the duration is free: make it constant, seek "
      "it, or fix the duration\n");
}

TEST(EndRows, RedundantConditionsCountOnce) {
  // A point on a hinged body has one freedom, its three components are one row; its orientation and equilibrium at the
  // same pose add none.
  ControlCase at = test::joint_case(8, 10.0);
  const double angle = 0.1;
  at.problem.final.coordinates.clear();
  const Eigen::Matrix3d turned = math::axis_rotation(2, angle);
  at.problem.final.points.push_back({.name = "points.end",
                                     .point = multibody::body_point(0, Vector3d(46.0, 0.0, 0.0)),
                                     .value = {92.0 * std::cos(angle), 92.0 * std::sin(angle), 0.0}});
  at.problem.final.orientations.push_back(
      {.name = "orientations.arm",
       .directors = {multibody::body_direction(0, Vector3d::UnitX()), multibody::body_direction(0, Vector3d::UnitY()),
                     multibody::body_direction(0, Vector3d::UnitZ())},
       .value = turned});
  const Trajectory guess = resting_guess(at.problem, 10.0);
  const Transcription nlp(at.problem, {}, guess);
  ASSERT_TRUE(nlp.faults().empty()) << nlp.faults()[0].why;
  EXPECT_EQ(nlp.n_constraints(), 8 + 1 + 1);  // balances of the nodes 0 .. 8, one row at the end
}

TEST(EndRows, LoopsAreClosedOnceWhereThePoseIsGiven) {
  test::RigidSystem system = test::four_bar({}, test::earth_gravity);
  system.joint_forces.push_back({.joint = 0, .control = 0});
  system.controls.push_back({.name = "torque", .unit = {}, .function = 0.0});
  ControlCase at(system);
  at.set_horizon(6, 5.0);
  at.seek_plain(1e3);
  at.start_at_rest();
  at.problem.final.x = at.model->manifold->reference();
  const Trajectory guess = resting_guess(at.problem, 5.0);
  const Transcription nlp(at.problem, {}, guess);
  ASSERT_TRUE(nlp.faults().empty()) << nlp.faults()[0].why;
  // Three tree coordinates, two independent loop rows: balances at 7 nodes, closing rows at the 5 inner ones.
  EXPECT_EQ(nlp.n_constraints(), 3 * 7 + 2 * 5);
}

TEST(KindOfControl, IsSquaredForFieldsAndPlainForForces) {
  const ControlCase joint = test::joint_case(5, 10.0);
  EXPECT_EQ(kind_of_control(*joint.model, 0), ControlKind::squared);
  const ControlCase slider(test::slider());
  EXPECT_EQ(kind_of_control(*slider.model, 0), ControlKind::plain);
  const ControlCase body(test::driven_free_body());
  for (int c = 0; c < 6; ++c) EXPECT_EQ(kind_of_control(*body.model, c), ControlKind::plain) << c;
}

}  // namespace
}  // namespace muldi::control
