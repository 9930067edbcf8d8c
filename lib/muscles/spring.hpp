#pragma once
/// A linear spring and damper between two points.
#include <optional>
#include <string>
#include <string_view>

#include "base/describe.hpp"
#include "muscles/axial.hpp"

namespace muldi::muscles {

/// The spring as a two-point element: Pi = k/2 (z - z0)^2, f = -c zd.
struct Spring {
  static constexpr std::string_view folder = "springs";
  static constexpr std::string_view noun = "spring";
  static constexpr int n_controls = 0;

  double stiffness = 0.0;
  double rest_length = 0.0;
  double damping = 0.0;

  template <class S>
  S elastic(const S& z) const {
    return 0.5 * stiffness * (z - rest_length) * (z - rest_length);
  }
  template <class S>
  S force(const S&, const S& zd, const Controls<S, 0>&) const {
    return -damping * zd;
  }
  bool dissipates() const { return damping > 0.0; }

  template <class S>
  AxialDerivatives<S, 0> axial(const S& z, const S& zd, const Controls<S, 0>&) const {
    return {.l_z = -stiffness * (z - rest_length), .l_zz = S(-stiffness), .f = -damping * zd, .f_d = S(-damping)};
  }

  /// Ends that coincide leave no direction, except to an undamped spring without rest length, whose force is linear.
  std::string inadmissible(double z) const;
};

/// What a scene says of a spring of the type `linear` beside its ends.
struct LinearSpring {
  static constexpr std::string_view name = "linear";
  static constexpr std::string_view doc = "a linear spring and damper, in tension and compression";

  double stiffness = 0.0;
  std::optional<double> rest_length = {};
  double damping = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using base::Field;
    using base::Need;
    visit(Field{.key = "stiffness",
                .doc = "force a length; 0 makes a pure damper",
                .unit = base::dimension::stiffness,
                .range = base::non_negative},
          self.stiffness);
    visit(Field{.key = "rest_length",
                .doc = "length without force; the distance in the scene pose if not given",
                .unit = base::dimension::length,
                .range = base::non_negative,
                .need = Need::optional},
          self.rest_length);
    visit(Field{.key = "damping",
                .doc = "force a rate of the length",
                .unit = base::dimension::damping,
                .range = base::non_negative,
                .need = Need::optional},
          self.damping);
  }

  friend bool operator==(const LinearSpring&, const LinearSpring&) = default;

  /// The element between ends that are `distance` apart in the scene pose.
  Spring element(double distance) const {
    return {.stiffness = stiffness, .rest_length = rest_length.value_or(distance), .damping = damping};
  }
};

}  // namespace muldi::muscles
