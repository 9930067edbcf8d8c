#pragma once
/// Velocity of something that moves as a rigid body: entries of `initial.bodies` and `initial.solids`.
#include <optional>

#include "base/describe.hpp"
#include "scene/bodies.hpp"

namespace muldi::scene {

/// Velocity of the centre of mass and angular velocity, world axes.
struct RigidVelocity {
  std::optional<Vec3> velocity = {};
  std::optional<Vec3> angular_velocity = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "velocity",
                .doc = "velocity of the centre of mass, world axes",
                .unit = dimension::velocity,
                .need = optional},
          self.velocity);
    visit(Field{.key = "angular_velocity",
                .doc = "angular velocity, world axes",
                .unit = dimension::angular_velocity,
                .need = optional},
          self.angular_velocity);
  }
  friend bool operator==(const RigidVelocity&, const RigidVelocity&) = default;
};

}  // namespace muldi::scene
