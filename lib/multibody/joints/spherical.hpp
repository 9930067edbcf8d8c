#pragma once
/// Three rotations about the joint point.
#include <array>
#include <string_view>

#include "base/describe.hpp"
#include "multibody/joint_pattern.hpp"

namespace muldi::multibody {

struct Spherical {
  static constexpr std::string_view name = "spherical";
  static constexpr std::string_view doc =
      "three rotations about a point; coordinates: rotation vector in the from-frame";

  template <class Self, class Visit>
  static void describe(Self&, Visit&) {}

  friend bool operator==(const Spherical&, const Spherical&) = default;

  /// Columns of the joint triad that the scene gives.
  template <class Set>
  void orient(Set) const {}

  static constexpr std::array constraints{primitive::coincident};
  static constexpr std::array motions{primitive::ball};
  static constexpr JointPattern pattern{.constraints = constraints, .motions = motions};
  static constexpr auto coordinates = coordinate_kinds<pattern.n_rates()>(pattern);
};

}  // namespace muldi::multibody
