#pragma once
/// Sliding in a plane and rotation about its normal.
#include <array>
#include <string_view>

#include "base/describe.hpp"
#include "multibody/joint_pattern.hpp"

namespace muldi::multibody {

struct Planar {
  static constexpr std::string_view name = "planar";
  static constexpr std::string_view doc = "sliding in a plane and rotation about its normal; coordinates: x, y, angle";

  base::Vec3 normal{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "normal", .doc = "normal of the plane"}, self.normal);
  }

  friend bool operator==(const Planar&, const Planar&) = default;

  /// Columns of the joint triad that the scene gives.
  template <class Set>
  void orient(Set set) const {
    set(2, normal);
  }

  static constexpr std::array constraints{primitive::no_slide(2), primitive::perpendicular(0, 2),
                                          primitive::perpendicular(1, 2)};
  static constexpr std::array motions{primitive::slide(0), primitive::slide(1), primitive::turn};
  static constexpr JointPattern pattern{.constraints = constraints, .motions = motions};
  static constexpr auto coordinates = coordinate_kinds<pattern.n_rates()>(pattern);
};

}  // namespace muldi::multibody
