#pragma once
/// The state at t = 0.
#include <span>
#include <string>
#include <vector>

#include "base/describe.hpp"
#include "scene/bodies.hpp"
#include "scene/entries.hpp"
#include "scene/joints.hpp"
#include "scene/rigid_velocity.hpp"
#include "scene/solids.hpp"

namespace muldi::scene {

/// Where the state at t = 0 comes from. In the input a word, or the path of an earlier record (`earlier.h5`).
struct InitialFrom {
  enum class Kind { scene, static_equilibrium, record };

  Kind kind = Kind::scene;
  std::string file = {};  ///< of a record, as written; path_of_file() finds it
  Origin origin = {};

  friend bool operator==(const InitialFrom&, const InitialFrom&) = default;
};

/// Initial position and velocity of a joint, one value a coordinate; empty: not given.
struct JointState {
  std::vector<double> position = {};
  std::vector<double> velocity = {};
  std::vector<Coordinate> coordinates = {};  ///< kinds, from the joint of this name

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(CoordinateField{.key = "position",
                          .doc = "coordinates at t = 0; they are zero in the scene pose",
                          .slide = dimension::length,
                          .angle = dimension::angle,
                          .coordinates = self.coordinates},
          self.position);
    visit(CoordinateField{.key = "velocity",
                          .doc = "velocities of the coordinates at t = 0",
                          .slide = dimension::velocity,
                          .angle = dimension::angular_velocity,
                          .coordinates = self.coordinates},
          self.velocity);
  }
  friend bool operator==(const JointState&, const JointState&) = default;
};

/// Initial generalised momentum of a joint's coordinates, of the whole coupled system. In the input a number or a list.
struct JointMomentum {
  std::vector<double> values = {};
  std::vector<Coordinate> coordinates = {};  ///< kinds, from the joint of this name

  friend bool operator==(const JointMomentum&, const JointMomentum&) = default;
};

/// The field that the values of a joint's momentum are.
inline CoordinateField momentum_field(std::string_view doc, std::span<const Coordinate> coordinates) {
  return {.key = {},
          .doc = doc,
          .slide = base::dimension::momentum,
          .angle = base::dimension::momentum * base::dimension::length,
          .range = base::any,
          .shared = false,
          .coordinates = coordinates};
}

/// Initial velocity of a body.
struct BodyVelocity : RigidVelocity {
  friend bool operator==(const BodyVelocity&, const BodyVelocity&) = default;
};

struct Initial {
  InitialFrom from = {};
  Named<JointState> joints = {};
  Named<BodyVelocity> bodies = {};
  Named<SolidVelocity> solids = {};
  Named<JointMomentum> momentum = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(
        Field{.key = "from",
              .doc =
                  "scene: as drawn; static_equilibrium: under the controls at t = 0; or an earlier record (*.h5, from "
                  "the scene's folder), whose last state becomes t = 0",
              .need = optional},
        self.from);
    visit(Field{.key = "joints", .doc = "joint coordinates and velocities by joint", .need = optional}, self.joints);
    visit(Field{.key = "bodies", .doc = "velocities by body", .need = optional}, self.bodies);
    visit(Field{.key = "solids", .doc = "velocities by solid", .need = optional}, self.solids);
    visit(Field{.key = "momentum",
                .doc = "generalised momentum of joint coordinates of the whole system (a shock), by joint",
                .need = optional},
          self.momentum);
  }
  friend bool operator==(const Initial&, const Initial&) = default;
};

}  // namespace muldi::scene
