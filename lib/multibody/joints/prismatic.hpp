#pragma once
/// Sliding along an axis without rotation.
#include <array>
#include <string_view>

#include "base/describe.hpp"
#include "multibody/joint_pattern.hpp"

namespace muldi::multibody {

struct Prismatic {
  static constexpr std::string_view name = "prismatic";
  static constexpr std::string_view doc = "sliding along an axis without rotation; coordinate: slide";

  base::Vec3 axis{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "axis", .doc = "direction of sliding"}, self.axis);
  }

  friend bool operator==(const Prismatic&, const Prismatic&) = default;

  /// Columns of the joint triad that the scene gives.
  template <class Set>
  void orient(Set set) const {
    set(2, axis);
  }

  static constexpr std::array constraints{primitive::no_slide(0), primitive::no_slide(1),
                                          primitive::perpendicular(0, 1), primitive::perpendicular(1, 2),
                                          primitive::perpendicular(2, 0)};
  static constexpr std::array motions{primitive::slide(2)};
  static constexpr JointPattern pattern{.constraints = constraints, .motions = motions};
  static constexpr auto coordinates = coordinate_kinds<pattern.n_rates()>(pattern);
};

}  // namespace muldi::multibody
