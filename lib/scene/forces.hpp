#pragma once
/// Springs between two points and loads on bodies.
#include <optional>
#include <span>

#include "base/describe.hpp"
#include "muscles/registry.hpp"
#include "scene/bodies.hpp"
#include "scene/controls.hpp"

namespace muldi::scene {

/// A passive element along the line between two points.
struct Spring {
  Attachment from = {};
  Attachment to = {};
  muscles::SpringType type = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "from", .doc = "first end"}, self.from);
    visit(Field{.key = "to", .doc = "second end"}, self.to);
    visit(Choice{.key = "type", .doc = "law of the spring", .need = Need::optional}, self.type);
  }
  friend bool operator==(const Spring&, const Spring&) = default;
};

/// Axes of the direction of a load.
enum class LoadFrame { world, body };

inline std::span<const base::Word<LoadFrame>> words(LoadFrame) {
  static constexpr base::Word<LoadFrame> all[] = {
      {.word = "world", .value = LoadFrame::world, .doc = "keeps its direction"},
      {.word = "body", .value = LoadFrame::body, .doc = "turns with the body"},
  };
  return all;
}

/// A force or torque on a body: vector x control, or vector x magnitude.
struct Load {
  BodyName body = {};
  std::optional<BodyPoint> at = {};  ///< given for a force
  std::optional<Vec3> force = {};    ///< exactly one of force and torque; without unit, not normalised
  std::optional<Vec3> torque = {};
  LoadFrame frame = LoadFrame::world;
  std::optional<ControlName> control = {};  ///< exactly one of control and magnitude
  std::optional<base::TimeFunction> magnitude = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "body", .doc = "name of a body"}, self.body);
    visit(Field{.key = "at",
                .doc = "where a force acts: name of a point of the body, or coordinates in body axes",
                .unit = dimension::length,
                .need = optional},
          self.at);
    visit(Field{.key = "force", .doc = "direction of a force; multiplies the control or magnitude", .need = optional},
          self.force);
    visit(Field{.key = "torque", .doc = "direction of a torque; multiplies the control or magnitude", .need = optional},
          self.torque);
    visit(Field{.key = "frame", .doc = "axes of the direction", .need = optional}, self.frame);
    visit(Field{.key = "control", .doc = "name of a control of force or torque", .need = optional}, self.control);
    visit(Field{.key = "magnitude",
                .doc = "function of time, instead of a control",
                .unit = self.torque ? dimension::torque : dimension::force,
                .need = optional},
          self.magnitude);
  }
  friend bool operator==(const Load&, const Load&) = default;
};

}  // namespace muldi::scene
