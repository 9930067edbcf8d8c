#pragma once
/// Rigid bodies and points on them.
#include <array>
#include <optional>
#include <string>

#include "base/describe.hpp"
#include "scene/entries.hpp"

namespace muldi::scene {

using base::Vec3;
/// Rows of a 3x3 matrix.
using Mat3 = std::array<Vec3, 3>;
inline constexpr Mat3 identity{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// Moments of inertia about the centre of mass in body axes: in the input three principal moments or a 3x3 tensor.
struct Inertia {
  Mat3 tensor = {};

  friend bool operator==(const Inertia&, const Inertia&) = default;
};

/// Body axes in the scene pose: the columns of `matrix` are the directors d1, d2, d3 in world axes. In the input
/// {axis, angle}, {euler: [x, y, z]} (turned about fixed x, then y, then z), {quaternion: [w, x, y, z]} or {matrix}.
struct Orientation {
  Mat3 matrix = identity;

  friend bool operator==(const Orientation&, const Orientation&) = default;
};

/// Puts a body where a joint of it closes.
struct PlaceAtJoint {
  JointName joint = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "joint", .doc = "joint of this body that closes in the scene pose"}, self.joint);
  }
  friend bool operator==(const PlaceAtJoint&, const PlaceAtJoint&) = default;
};

struct Body {
  double mass = 0.0;
  Inertia inertia = {};
  std::optional<Vec3> position = {};  ///< centre of mass in the scene pose, world axes; exactly one of position and
  std::optional<PlaceAtJoint> place = {};  ///< place is given
  Orientation orientation = {};
  Named<Vec3> points = {};  ///< body axes, from the centre of mass

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "mass", .doc = "mass", .unit = dimension::mass, .range = positive}, self.mass);
    visit(Field{.key = "inertia",
                .doc = "principal moments about the centre of mass in body axes, or a full 3x3 tensor",
                .unit = dimension::inertia},
          self.inertia);
    visit(Field{.key = "position",
                .doc = "centre of mass in the scene pose; or give `place`",
                .unit = dimension::length,
                .need = optional},
          self.position);
    visit(Field{.key = "place", .doc = "puts the body where a joint closes, instead of `position`", .need = optional},
          self.place);
    visit(Field{.key = "orientation",
                .doc = "body axes in the scene pose: {axis, angle}, {euler: [x, y, z]} about fixed axes, "
                       "{quaternion: [w, x, y, z]} or {matrix}; default world axes",
                .need = optional},
          self.orientation);
    visit(Field{.key = "points",
                .doc = "named points in body axes, from the centre of mass",
                .unit = dimension::length,
                .need = optional},
          self.points);
  }
  friend bool operator==(const Body&, const Body&) = default;
};

/// A point of a body: `name` of one of its points, or coordinates. The reader has put the coordinates of a named point
/// into `position`.
struct BodyPoint {
  std::string name = {};  ///< empty for plain coordinates
  Vec3 position = {};     ///< body axes from the centre of mass; world for the ground
  Origin origin = {};

  friend bool operator==(const BodyPoint&, const BodyPoint&) = default;
};

/// An end of a joint, muscle or spring: a point fixed to a body or to the ground.
struct Attachment {
  BodyName body = {};
  BodyPoint at = {};

  bool on_ground() const { return body.name == ground; }

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "body", .doc = "name of a body, or `ground`"}, self.body);
    visit(base::Field{.key = "at",
                      .doc = "name of a point of the body, or coordinates in body axes (world for the ground)",
                      .unit = base::dimension::length},
          self.at);
  }
  friend bool operator==(const Attachment&, const Attachment&) = default;
};

}  // namespace muldi::scene
