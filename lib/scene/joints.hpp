#pragma once
/// Joints between two bodies, or a body and the ground.
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "base/describe.hpp"
#include "multibody/registry.hpp"
#include "scene/bodies.hpp"
#include "scene/controls.hpp"

namespace muldi::scene {

using multibody::Coordinate;

/// Axes in which the vectors of a joint (axis, axis2, normal) are given.
enum class JointFrame { scene, from, to };

inline std::span<const base::Word<JointFrame>> words(JointFrame) {
  static constexpr base::Word<JointFrame> all[] = {
      {.word = "scene", .value = JointFrame::scene, .doc = "world axes in the scene pose"},
      {.word = "from", .value = JointFrame::from, .doc = "body axes of `from`"},
      {.word = "to", .value = JointFrame::to, .doc = "body axes of `to`"},
  };
  return all;
}

/// A field with a value for each joint coordinate: a list, or a single value for a single coordinate.
struct CoordinateField {
  std::string_view key;
  std::string_view doc;
  base::Dimension slide;  ///< dimension where the coordinate is a length; none: not for these
  base::Dimension angle;  ///< dimension where it is an angle; none: not for these
  base::Range range = base::any;
  bool shared = false;                           ///< one value may stand for all coordinates where they are of one kind
  std::span<const Coordinate> coordinates = {};  ///< kinds of the coordinates of this joint
};

/// A spring and damper that act outside a range of a joint coordinate.
struct Stops {
  std::array<double, 2> range = {};  ///< lowest and highest free value of the coordinate
  double stiffness = 0.0;
  double damping = 0.0;

  friend bool operator==(const Stops&, const Stops&) = default;
};

/// describe() of the stops of a coordinate of this kind.
template <class Self, class Visit>
void describe_stops(Coordinate kind, Self& stops, Visit& visit) {
  using namespace base;
  const bool slide = kind == Coordinate::slide;
  visit(Field{.key = "range",
              .doc = "lowest and highest free value of the coordinate",
              .unit = slide ? dimension::length : dimension::angle},
        stops.range);
  visit(Field{.key = "stiffness",
              .doc = "stiffness outside the range",
              .unit = slide ? dimension::stiffness : dimension::rotational_stiffness,
              .range = positive},
        stops.stiffness);
  visit(Field{.key = "damping",
              .doc = "damping outside the range",
              .unit = slide ? dimension::damping : dimension::rotational_damping,
              .range = non_negative,
              .need = Need::optional},
        stops.damping);
}

struct Joint {
  multibody::JointType type = {};
  Attachment from = {};
  Attachment to = {};
  JointFrame frame = JointFrame::scene;
  std::vector<double> stiffness = {};            ///< these three: empty, or one a coordinate
  std::vector<double> damping = {};              ///<
  std::vector<double> rest = {};                 ///< coordinates at which the stiffness acts with no force
  std::vector<Drive> force = {};                 ///< empty, or one a slide of the joint, on `to` along it
  std::vector<Drive> torque = {};                ///< empty, or one an angle of the joint, on `to` about it
  std::vector<std::optional<Stops>> stops = {};  ///< empty, or one a coordinate

  /// Kinds of the joint's coordinates in their order.
  std::span<const Coordinate> coordinates() const;
  /// The force or torque that drives coordinate `i`, or null.
  const Drive* drive(std::size_t i) const;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Choice{.key = "type", .doc = "joint type"}, self.type);
    visit(Field{.key = "from", .doc = "the end that moves `to` relative to it"}, self.from);
    visit(Field{.key = "to", .doc = "the end whose motion relative to `from` the coordinates measure"}, self.to);
    visit(Field{.key = "frame", .doc = "axes of the vectors of this joint", .need = optional}, self.frame);
    const std::span<const Coordinate> kinds = self.coordinates();
    visit(CoordinateField{.key = "stiffness",
                          .doc = "stiffness of a spring on the coordinate",
                          .slide = dimension::stiffness,
                          .angle = dimension::rotational_stiffness,
                          .range = non_negative,
                          .shared = true,
                          .coordinates = kinds},
          self.stiffness);
    visit(CoordinateField{.key = "damping",
                          .doc = "damping of the coordinate's velocity",
                          .slide = dimension::damping,
                          .angle = dimension::rotational_damping,
                          .range = non_negative,
                          .shared = true,
                          .coordinates = kinds},
          self.damping);
    visit(CoordinateField{.key = "rest",
                          .doc = "coordinate at which the spring has no force; default the scene pose",
                          .slide = dimension::length,
                          .angle = dimension::angle,
                          .coordinates = kinds},
          self.rest);
    visit(CoordinateField{.key = "force",
                          .doc = "force along the slides: function of time or {control: name}",
                          .slide = dimension::force,
                          .angle = dimension::none,
                          .coordinates = kinds},
          self.force);
    visit(CoordinateField{.key = "torque",
                          .doc = "torque about the angles: function of time or {control: name}",
                          .slide = dimension::none,
                          .angle = dimension::torque,
                          .coordinates = kinds},
          self.torque);
    visit(CoordinateField{.key = "stops",
                          .doc = "{range: [low, high], stiffness, damping} of springs outside the range; ~ for none",
                          .slide = dimension::stiffness,
                          .angle = dimension::rotational_stiffness,
                          .shared = true,
                          .coordinates = kinds},
          self.stops);
  }
  friend bool operator==(const Joint&, const Joint&) = default;
};

}  // namespace muldi::scene
