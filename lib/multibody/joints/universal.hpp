#pragma once
/// Two rotations about perpendicular axes: the first fixed to `from`, the second to `to`.
#include <array>
#include <string_view>

#include "base/describe.hpp"
#include "multibody/joint_pattern.hpp"

namespace muldi::multibody {

struct Universal {
  static constexpr std::string_view name = "universal";
  static constexpr std::string_view doc =
      "rotations about two perpendicular axes, the first fixed to `from`, the second to `to`; coordinates: both angles";

  base::Vec3 axis{};
  base::Vec3 axis2{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "axis", .doc = "axis fixed to `from`"}, self.axis);
    visit(base::Field{.key = "axis2", .doc = "axis fixed to `to`, perpendicular to `axis` in the scene pose"},
          self.axis2);
  }

  friend bool operator==(const Universal&, const Universal&) = default;

  /// Columns of the joint triad that the scene gives.
  template <class Set>
  void orient(Set set) const {
    set(0, axis);
    set(1, axis2);
  }

  /// With e_2^B = cos(angle 1) e_2^A + sin(angle 1) e_3^A; e_1^A is perpendicular to e_2^B, so this is never singular.
  static constexpr Motion about_first{
      .kind = Motion::Kind::rotation_a, .axis = 0, .sine = {{{2, 1, 1.0}}}, .cosine = {{{1, 1, 1.0}}}};
  static constexpr Motion about_second{
      .kind = Motion::Kind::rotation_b, .axis = 1, .sine = {{{0, 2, 1.0}}}, .cosine = {{{0, 0, 1.0}}}};
  static constexpr std::array constraints{primitive::coincident, primitive::perpendicular(0, 1)};
  static constexpr std::array motions{about_first, about_second};
  static constexpr JointPattern pattern{.constraints = constraints, .motions = motions};
  static constexpr auto coordinates = coordinate_kinds<pattern.n_rates()>(pattern);
};

}  // namespace muldi::multibody
