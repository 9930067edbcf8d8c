#pragma once
/// A ball that slides along a rail and turns every way.
#include <array>
#include <string_view>

#include "base/describe.hpp"
#include "multibody/joint_pattern.hpp"

namespace muldi::multibody {

struct BallOnRail {
  static constexpr std::string_view name = "ball_on_rail";
  static constexpr std::string_view doc =
      "any rotation about a point that slides along an axis; coordinates: slide, rotation vector in the from-frame";

  base::Vec3 axis{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "axis", .doc = "direction of sliding"}, self.axis);
  }

  friend bool operator==(const BallOnRail&, const BallOnRail&) = default;

  /// The scene's axis is e_3 of the joint triad.
  template <class Set>
  void orient(Set set) const {
    set(2, axis);
  }

  static constexpr std::array constraints{primitive::no_slide(0), primitive::no_slide(1)};
  static constexpr std::array motions{primitive::slide(2), primitive::ball};
  static constexpr JointPattern pattern{.constraints = constraints, .motions = motions};
  static constexpr auto coordinates = coordinate_kinds<pattern.n_rates()>(pattern);
};

}  // namespace muldi::multibody
