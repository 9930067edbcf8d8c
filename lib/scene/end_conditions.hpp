#pragma once
/// Conditions on the state at one moment, and values of joints and points that optimal control asks for.
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "base/describe.hpp"
#include "base/time_function.hpp"
#include "scene/bodies.hpp"
#include "scene/entries.hpp"
#include "scene/initial.hpp"
#include "scene/joints.hpp"
#include "scene/tasks.hpp"

namespace muldi::scene {

/// Coordinates of a joint, ~ where free. In the input a number, or a list with one value a coordinate.
struct JointPosition {
  std::vector<std::optional<double>> values = {};
  std::vector<Coordinate> coordinates = {};  ///< kinds, from the joint of this name

  friend bool operator==(const JointPosition&, const JointPosition&) = default;
};

/// Velocities of the coordinates of a joint. In the input as JointPosition.
struct JointVelocity {
  std::vector<std::optional<double>> values = {};
  std::vector<Coordinate> coordinates = {};

  friend bool operator==(const JointVelocity&, const JointVelocity&) = default;
};

/// Lowest and highest value, ~ where there is none.
using Bounds = std::array<std::optional<double>, 2>;

/// Bounds of the coordinates of a joint: [low, high], or a list of them, ~ where free.
struct JointRange {
  std::vector<std::optional<Bounds>> values = {};
  std::vector<Coordinate> coordinates = {};

  friend bool operator==(const JointRange&, const JointRange&) = default;
};

/// Wanted coordinates of a joint over time: a function, or a list of them, ~ where free.
struct JointTrajectory {
  std::vector<std::optional<base::TimeFunction>> values = {};
  std::vector<Coordinate> coordinates = {};

  friend bool operator==(const JointTrajectory&, const JointTrajectory&) = default;
};

/// The field that positions, ranges and trajectories of a joint are.
inline CoordinateField position_field(std::string_view doc, std::span<const Coordinate> coordinates) {
  return {.key = {},
          .doc = doc,
          .slide = base::dimension::length,
          .angle = base::dimension::angle,
          .range = base::any,
          .shared = false,
          .coordinates = coordinates};
}
/// The field that velocities of a joint are.
inline CoordinateField velocity_field(std::string_view doc, std::span<const Coordinate> coordinates) {
  CoordinateField field = position_field(doc, coordinates);
  field.slide = base::dimension::velocity;
  field.angle = base::dimension::angular_velocity;
  return field;
}

/// A point, ~ where a component is free.
using PartialPoint = std::array<std::optional<double>, 3>;
/// Lowest and highest corner, ~ where there is none.
using PointBox = std::array<PartialPoint, 2>;
/// A wanted path, ~ where a component is free.
using PointTrajectory = std::array<std::optional<base::TimeFunction>, 3>;

/// Values by point of a body: in the input a map with keys `body.point`.
template <class T>
struct ByPoint {
  struct Item {
    RecordedPoint point = {};
    T value = {};
    Origin origin = {};

    friend bool operator==(const Item&, const Item&) = default;
  };
  std::vector<Item> items = {};

  bool empty() const { return items.empty(); }
  friend bool operator==(const ByPoint&, const ByPoint&) = default;
};

/// A wanted place of a body.
struct BodyPose {
  std::optional<PartialPoint> position = {};
  std::optional<Orientation> orientation = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "position", .doc = "centre of mass, ~ where free", .unit = dimension::length, .need = optional},
          self.position);
    visit(Field{.key = "orientation", .doc = "body axes, as of bodies", .need = optional}, self.orientation);
  }
  friend bool operator==(const BodyPose&, const BodyPose&) = default;
};

/// Places: joint coordinates, bodies, points, orientations. All of them hold together.
struct Pose {
  Named<JointPosition> joints = {};
  Named<BodyPose> bodies = {};
  ByPoint<PartialPoint> points = {};
  Named<Orientation> orientations = {};

  bool empty() const { return joints.empty() && bodies.empty() && points.empty() && orientations.empty(); }

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "joints", .doc = "joint coordinates by joint", .need = optional}, self.joints);
    visit(Field{.key = "bodies", .doc = "{position, orientation} by body", .need = optional}, self.bodies);
    visit(Field{.key = "points",
                .doc = "places of points by `body.point`, ~ where free",
                .unit = dimension::length,
                .need = optional},
          self.points);
    visit(Field{.key = "orientations", .doc = "orientations by body, as of bodies", .need = optional},
          self.orientations);
  }
  friend bool operator==(const Pose&, const Pose&) = default;
};

/// Momentum at an end. In the input rest, free, or {joint: generalised momentum}.
struct EndMomentum {
  enum class Kind { rest, free, given };

  Kind kind = Kind::free;
  Named<JointMomentum> joints = {};  ///< with `given`

  friend bool operator==(const EndMomentum&, const EndMomentum&) = default;
};

/// A value at which a control is held, in its unit.
struct HeldControl {
  double value = 0.0;
  base::Dimension unit = {};  ///< from the control of this name

  friend bool operator==(const HeldControl&, const HeldControl&) = default;
};

enum class WholePose { scene };

inline std::span<const base::Word<WholePose>> words(WholePose) {
  static constexpr base::Word<WholePose> all[] = {
      {.word = "scene", .value = WholePose::scene, .doc = "the pose in which `run` would start: that of `initial:`"},
  };
  return all;
}

/// What holds at one end of the horizon; what is not said is free.
struct EndCondition {
  std::optional<WholePose> whole = {};  ///< then `pose` is empty
  Pose pose = {};
  std::optional<EndMomentum> momentum = {};  ///< exactly one of momentum and velocity is given
  Named<JointVelocity> velocity = {};        ///< velocities of the other coordinates are zero

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "pose",
                .doc = "the pose of all bodies; or give joints, bodies, points, orientations",
                .need = optional},
          self.whole);
    Pose::describe(self.pose, visit);
    visit(Field{.key = "momentum", .doc = "rest, free, or {joint: generalised momentum}", .need = optional},
          self.momentum);
    visit(Field{.key = "velocity",
                .doc = "joint velocities by joint instead of a momentum; the others are zero",
                .need = optional},
          self.velocity);
  }
  friend bool operator==(const EndCondition&, const EndCondition&) = default;
};

/// The end of the horizon.
struct FinalCondition {
  EndCondition end = {};
  Named<HeldControl> equilibrium = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    EndCondition::describe(self.end, visit);
    visit(base::Field{.key = "equilibrium",
                      .doc = "the pose is a static equilibrium under the controls held at these values",
                      .need = base::Need::optional},
          self.equilibrium);
  }
  friend bool operator==(const FinalCondition&, const FinalCondition&) = default;
};

}  // namespace muldi::scene
