#pragma once
/// No constraint: all six motions of B relative to A.
#include <array>
#include <string_view>

#include "base/describe.hpp"
#include "multibody/joint_pattern.hpp"

namespace muldi::multibody {

struct Free {
  static constexpr std::string_view name = "free";
  static constexpr std::string_view doc = "no constraint; coordinates: position and rotation vector in the from-frame";

  template <class Self, class Visit>
  static void describe(Self&, Visit&) {}

  friend bool operator==(const Free&, const Free&) = default;

  /// Columns of the joint triad that the scene gives.
  template <class Set>
  void orient(Set) const {}

  static constexpr std::array<Constraint, 0> constraints{};
  static constexpr std::array motions{primitive::slide(0), primitive::slide(1), primitive::slide(2), primitive::ball};
  static constexpr JointPattern pattern{.constraints = constraints, .motions = motions};
  static constexpr auto coordinates = coordinate_kinds<pattern.n_rates()>(pattern);
};

}  // namespace muldi::multibody
