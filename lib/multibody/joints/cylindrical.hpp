#pragma once
/// Sliding along and rotation about one axis.
#include <array>
#include <string_view>

#include "base/describe.hpp"
#include "multibody/joint_pattern.hpp"

namespace muldi::multibody {

struct Cylindrical {
  static constexpr std::string_view name = "cylindrical";
  static constexpr std::string_view doc = "sliding along and rotation about one axis; coordinates: slide, angle";

  base::Vec3 axis{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "axis", .doc = "axis of sliding and rotation"}, self.axis);
  }

  friend bool operator==(const Cylindrical&, const Cylindrical&) = default;

  /// Columns of the joint triad that the scene gives.
  template <class Set>
  void orient(Set set) const {
    set(2, axis);
  }

  static constexpr std::array constraints{primitive::no_slide(0), primitive::no_slide(1),
                                          primitive::perpendicular(0, 2), primitive::perpendicular(1, 2)};
  static constexpr std::array motions{primitive::slide(2), primitive::turn};
  static constexpr JointPattern pattern{.constraints = constraints, .motions = motions};
  static constexpr auto coordinates = coordinate_kinds<pattern.n_rates()>(pattern);
};

}  // namespace muldi::multibody
