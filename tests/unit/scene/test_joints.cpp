#include "scene/joints.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reading.hpp"

namespace muldi::scene {
namespace {

Joint read(const std::string& fields, const std::string& more = {}) {
  return scene_of(joint(fields) + more).joints[0].value;
}

const double degree = std::acos(-1.0) / 180;

TEST(Joints, EveryTypeHasItsCoordinates) {
  const auto n = [](const std::string& fields) { return read(fields).coordinates().size(); };
  EXPECT_EQ(n("type: fixed"), 0u);
  EXPECT_EQ(n("type: spherical"), 3u);
  EXPECT_EQ(n("type: revolute, axis: [0, 0, 1]"), 1u);
  EXPECT_EQ(n("type: cylindrical, axis: [0, 0, 1]"), 2u);
  EXPECT_EQ(n("type: prismatic, axis: [0, 0, 1]"), 1u);
  EXPECT_EQ(n("type: planar, normal: [0, 0, 1]"), 3u);
  EXPECT_EQ(n("type: universal, axis: [0, 0, 1], axis2: [1, 0, 0]"), 2u);
  EXPECT_EQ(n("type: free"), 6u);
}

TEST(Joints, ReadAxesAndFrame) {
  const Joint universal = read("type: universal, axis: [0, 0, 2], axis2: [1, 0, 0], frame: to");
  EXPECT_EQ(std::get<multibody::Universal>(universal.type).axis, (Vec3{0, 0, 2}));
  EXPECT_EQ(std::get<multibody::Universal>(universal.type).axis2, (Vec3{1, 0, 0}));
  EXPECT_EQ(universal.frame, JointFrame::to);
  EXPECT_EQ(read("type: free").frame, JointFrame::scene);
}

TEST(Joints, SpringsTakeTheUnitsOfTheirCoordinates) {
  const Joint revolute =
      read("type: revolute, axis: [0, 0, 1], stiffness: 1 N m/rad, damping: 2 N mm ms, rest: 10 deg");
  EXPECT_EQ(revolute.stiffness, std::vector{1000.0});
  EXPECT_EQ(revolute.damping, std::vector{2.0});
  EXPECT_DOUBLE_EQ(revolute.rest[0], 10 * degree);
  const Joint cylindrical = read("type: cylindrical, axis: [0, 0, 1], stiffness: [1 N/m, 2 N mm/rad], rest: [1 cm, 0]");
  EXPECT_EQ(cylindrical.stiffness, (std::vector{1e-3, 2.0}));
  EXPECT_EQ(cylindrical.rest, (std::vector{10.0, 0.0}));
  EXPECT_TRUE(cylindrical.damping.empty());
}

TEST(Joints, OneStiffnessMayHoldForCoordinatesOfOneKind) {
  EXPECT_EQ(read("type: spherical, stiffness: 3").stiffness, (std::vector{3.0, 3.0, 3.0}));
  EXPECT_EQ(read("type: spherical, stiffness: [1, 2, 3]").stiffness, (std::vector{1.0, 2.0, 3.0}));
  EXPECT_EQ(errors_of(joint("type: spherical, rest: 3")),
            "test.yaml:3:100: error: joints.j.rest: needs [angle, angle, angle], got '3'");
}

TEST(Joints, DrivesBelongToSlidesAndAngles) {
  const Joint planar = read(
      "type: planar, normal: [0, 0, 1], force: [1, {control: u}], torque: {sine: {amplitude: 2, frequency: 1 kHz}}",
      "controls: {u: {force: 5}}\n");
  EXPECT_EQ(planar.drive(0)->value.at(0.0), 1.0);
  EXPECT_EQ(planar.drive(1)->control.name, "u");
  EXPECT_DOUBLE_EQ(planar.drive(2)->value.at(0.25), 2.0);  // a quarter of a period of 1 ms
  const Joint slide = read("type: prismatic, axis: [1, 0, 0], force: 3 kN");
  EXPECT_EQ(slide.drive(0)->value.at(0.0), 3000.0);
  EXPECT_EQ(read("type: prismatic, axis: [1, 0, 0]").drive(0), nullptr);
}

TEST(Joints, UndrivenCoordinatesOfAListAreLeftOut) {
  const Joint ball = read("type: spherical, torque: [~, 2, ~]");
  EXPECT_EQ(ball.drive(0)->value.at(0.0), 0.0);
  EXPECT_EQ(ball.drive(1)->value.at(0.0), 2.0);
}

TEST(Joints, StopsActPerCoordinate) {
  const Joint cylindrical =
      read("type: cylindrical, axis: [0, 0, 1], stops: [~, {range: [-10 deg, 20 deg], stiffness: 5}]");
  EXPECT_FALSE(cylindrical.stops[0].has_value());
  EXPECT_DOUBLE_EQ(cylindrical.stops[1]->range[0], -10 * degree);
  EXPECT_DOUBLE_EQ(cylindrical.stops[1]->range[1], 20 * degree);
  EXPECT_EQ(cylindrical.stops[1]->stiffness, 5.0);
  EXPECT_EQ(cylindrical.stops[1]->damping, 0.0);
  const Joint slide =
      read("type: prismatic, axis: [1, 0, 0], stops: {range: [0, 1 cm], stiffness: 5, damping: 1 N s/m}");
  EXPECT_EQ(slide.stops[0]->range, (std::array{0.0, 10.0}));
  EXPECT_EQ(slide.stops[0]->damping, 1.0);  // N ms/mm
}

TEST(InitialState, TakesTheUnitsOfTheJointsCoordinates) {
  const Scene scene = scene_of(joint("type: cylindrical, axis: [0, 0, 1]") +
                               "initial:\n"
                               "  joints: {j: {position: [1 cm, 10 deg]}}\n"
                               "  momentum: {j: [2 N ms, 5000]}\n"
                               "  bodies: {arm: {velocity: [1 m/s, 0, 0], angular_velocity: [0, 1 rad/s, 0]}}\n");
  const JointState& state = scene.initial.joints.find("j")->value;
  EXPECT_EQ(state.position[0], 10.0);
  EXPECT_DOUBLE_EQ(state.position[1], 10 * degree);
  EXPECT_TRUE(state.velocity.empty());
  EXPECT_EQ(scene.initial.momentum.find("j")->value.values, (std::vector{2.0, 5000.0}));
  EXPECT_EQ(*scene.initial.bodies.find("arm")->value.velocity, (Vec3{1, 0, 0}));
  EXPECT_EQ(*scene.initial.bodies.find("arm")->value.angular_velocity, (Vec3{0, 1e-3, 0}));
}

TEST(InitialState, ComesFromTheSceneEquilibriumOrARecord) {
  using Kind = InitialFrom::Kind;
  EXPECT_EQ(scene_of("").initial.from.kind, Kind::scene);
  EXPECT_EQ(scene_of("initial: {from: static_equilibrium}\n").initial.from.kind, Kind::static_equilibrium);
  const InitialFrom record = scene_of("initial: {from: runs/earlier.h5}\n").initial.from;
  EXPECT_EQ(record.kind, Kind::record);
  EXPECT_EQ(record.file, "runs/earlier.h5");
}

}  // namespace
}  // namespace muldi::scene
