#include "scene/bodies.hpp"

#include <gtest/gtest.h>

#include "reading.hpp"

namespace muldi::scene {
namespace {

std::string body(const std::string& inertia) {
  return "bodies: {b: {mass: 40 g, inertia: " + inertia + ", position: [1 cm, 0, 0]}}\n";
}

TEST(Bodies, TakePrincipalMomentsOrATensor) {
  const Body principal = scene_of(body("[1.0e+5, 3.17e+5, 3.17e+5]")).bodies[0].value;
  EXPECT_EQ(principal.inertia.tensor, (Mat3{{{1e5, 0, 0}, {0, 3.17e5, 0}, {0, 0, 3.17e5}}}));
  EXPECT_EQ(*principal.position, (Vec3{10, 0, 0}));
  EXPECT_EQ(principal.orientation.matrix, identity);
  const Body full = scene_of(body("[[2, 0.1, 0], [0.1, 2, 0], [0, 0, 3 g mm^2]]")).bodies[0].value;
  EXPECT_EQ(full.inertia.tensor, (Mat3{{{2, 0.1, 0}, {0.1, 2, 0}, {0, 0, 3}}}));
}

TEST(Bodies, ThinBodiesAreAllowed) {
  EXPECT_EQ(errors_of(body("[1, 1, 2]")), "");                          // a disc
  EXPECT_EQ(errors_of(body("[0, 1, 1]")), "");                          // a rod
  EXPECT_EQ(errors_of(body("[1.3333333, 1.3333333, 2.6666667]")), "");  // rounded where it was written
}

TEST(Bodies, TurnedTensorsObeyTheTriangleInequality) {
  // Principal moments 1, 2 and 2.9 or 3.1, turned by 45 degrees about z.
  EXPECT_EQ(errors_of(body("[[1.5, 0.5, 0], [0.5, 1.5, 0], [0, 0, 2.9]]")), "");
  EXPECT_EQ(errors_of(body("[[1.5, 0.5, 0], [0.5, 1.5, 0], [0, 0, 3.1]]")),
            "test.yaml:2:35: error: bodies.b.inertia: no body has this inertia: no principal moment may exceed the sum "
            "of the other two");
}

TEST(Bodies, KeepTheirPlaces) {
  const Scene scene = scene_of(arm);
  EXPECT_EQ(scene.bodies[0].origin.place, (base::Place{.file = "test.yaml", .line = 2, .column = 10}));
  EXPECT_EQ(scene.bodies[0].origin.path, "bodies.arm");
  EXPECT_EQ(to_string(error_at(scene.bodies[0].origin, "too heavy")), "test.yaml:2:10: error: bodies.arm: too heavy");
}

TEST(Bodies, SectionsFindByName) {
  const Scene scene = scene_of(
      "bodies:\n"
      "  b: {mass: 1, inertia: [1, 1, 1], position: [0, 0, 0]}\n"
      "  a: {mass: 2, inertia: [1, 1, 1], position: [0, 0, 0]}\n");
  EXPECT_EQ(scene.bodies.names(), (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(scene.bodies.index("a"), 1);
  EXPECT_EQ(scene.bodies.index("c"), -1);
  EXPECT_EQ(scene.bodies.find("a")->value.mass, 2.0);
  EXPECT_EQ(scene.bodies.find("c"), nullptr);
}

TEST(Bodies, ArePlacedByAJoint) {
  const Scene scene = scene_of(
      "bodies: {b: {mass: 1, inertia: [1, 1, 1], place: {joint: j}}}\n"
      "joints: {j: {type: fixed, from: {body: ground, at: [0, 0, 0]}, to: {body: b, at: [0, 0, 0]}}}\n");
  EXPECT_FALSE(scene.bodies[0].value.position.has_value());
  EXPECT_EQ(scene.bodies[0].value.place->joint.name, "j");
}

TEST(Attachments, NamedPointsAreResolved) {
  const Joint read = scene_of(joint("type: fixed")).joints[0].value;
  EXPECT_TRUE(read.from.on_ground());
  EXPECT_FALSE(read.to.on_ground());
  EXPECT_EQ(read.to.at.name, "tip");
  EXPECT_EQ(read.to.at.position, (Vec3{1, 0, 0}));
}

TEST(RecordedPoints, NameBodyAndPoint) {
  const Scene scene = scene_of(arm + "record: {every: 10, points: [arm.tip]}\n");
  EXPECT_EQ(scene.record.every, 10);
  EXPECT_EQ(scene.record.points[0].body.name, "arm");
  EXPECT_EQ(scene.record.points[0].point.position, (Vec3{1, 0, 0}));
}

}  // namespace
}  // namespace muldi::scene
