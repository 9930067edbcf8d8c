#pragma once
/// One rotation about an axis through the joint point.
#include <array>
#include <string_view>

#include "base/describe.hpp"
#include "multibody/joint_pattern.hpp"

namespace muldi::multibody {

struct Revolute {
  static constexpr std::string_view name = "revolute";
  static constexpr std::string_view doc = "one rotation about an axis; coordinate: angle";

  base::Vec3 axis{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "axis", .doc = "axis of rotation"}, self.axis);
  }

  friend bool operator==(const Revolute&, const Revolute&) = default;

  /// Columns of the joint triad that the scene gives.
  template <class Set>
  void orient(Set set) const {
    set(2, axis);
  }

  static constexpr std::array constraints{primitive::coincident, primitive::perpendicular(0, 2),
                                          primitive::perpendicular(1, 2)};
  static constexpr std::array motions{primitive::turn};
  static constexpr JointPattern pattern{.constraints = constraints, .motions = motions};
  static constexpr auto coordinates = coordinate_kinds<pattern.n_rates()>(pattern);
};

}  // namespace muldi::multibody
