#pragma once
/// No relative motion.
#include <array>
#include <string_view>

#include "base/describe.hpp"
#include "multibody/joint_pattern.hpp"

namespace muldi::multibody {

struct Fixed {
  static constexpr std::string_view name = "fixed";
  static constexpr std::string_view doc = "no relative motion";

  template <class Self, class Visit>
  static void describe(Self&, Visit&) {}

  friend bool operator==(const Fixed&, const Fixed&) = default;

  /// Columns of the joint triad that the scene gives.
  template <class Set>
  void orient(Set) const {}

  static constexpr std::array constraints{primitive::coincident, primitive::perpendicular(0, 1),
                                          primitive::perpendicular(1, 2), primitive::perpendicular(2, 0)};
  static constexpr std::array<Motion, 0> motions{};
  static constexpr JointPattern pattern{.constraints = constraints, .motions = motions};
  static constexpr auto coordinates = coordinate_kinds<pattern.n_rates()>(pattern);
};

}  // namespace muldi::multibody
