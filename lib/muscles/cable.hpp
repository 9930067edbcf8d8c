#pragma once
/// A cable between two points: it pulls and never pushes.
///
/// With the elongation x = z - z0 and the width w over which the cable tightens, the elastic elongation is
///
///     e(x) = 0 (x <= 0),   w (s^3 - s^4/2), s = x/w (0 < x < w),   x - w/2 (x >= w) ,
///
/// twice continuously differentiable, so that the stiffness k e' of the tension N = k e is smooth where the cable goes
/// slack. The damper follows the elastic elongation, D = -c de/dt = -c e' zd. A cable that shortens loses its tension
/// and no more: there the force is D N/(N^4 + D^4)^(1/4), D where D << N, never above N.
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "base/describe.hpp"
#include "math/jet.hpp"
#include "muscles/axial.hpp"

namespace muldi::muscles {

/// The cable as a two-point element: Pi = k int e dx and the damping force above.
struct Cable {
  static constexpr std::string_view folder = "springs";
  static constexpr std::string_view noun = "spring";
  static constexpr int n_controls = 0;

  double stiffness = 0.0;
  double rest_length = 0.0;
  double damping = 0.0;
  double transition = 0.0;  ///< w

  template <class S>
  S elastic(const S& z) const {
    const S x = z - rest_length;
    if (math::number(x) <= 0.0) return S(0.0);
    if (math::number(x) >= transition) {
      const S e = x - 0.5 * transition;
      return 0.5 * stiffness * (e * e + 0.05 * transition * transition);
    }
    const S s = x / transition;
    return stiffness * transition * transition * s * s * s * s * (0.25 - 0.1 * s);
  }
  template <class S>
  S force(const S& z, const S& zd, const Controls<S, 0>&) const {
    const S x = z - rest_length;
    if (math::number(x) <= 0.0) return S(0.0);
    S e = x - 0.5 * transition;
    S slope = S(1.0);
    if (math::number(x) < transition) {
      const S s = x / transition;
      e = transition * s * s * s * (1.0 - 0.5 * s);
      slope = s * s * (3.0 - 2.0 * s);
    }
    const S drag = -damping * slope * zd;
    if (math::number(drag) <= 0.0) return drag;
    using std::sqrt;
    const S tension = stiffness * e;
    const S tension_2 = tension * tension;
    const S drag_2 = drag * drag;
    return drag * tension / sqrt(S(sqrt(S(tension_2 * tension_2 + drag_2 * drag_2))));
  }
  bool dissipates() const { return damping > 0.0; }

  /// A slack cable has no force that would need a direction.
  static std::string inadmissible(double z) { return std::isfinite(z) ? "" : "its length is not finite"; }
};

/// What a scene says of a spring of the type `cable` beside its ends.
struct CableSpring {
  static constexpr std::string_view name = "cable";
  static constexpr std::string_view doc =
      "a cable or tendon: pulls where it is longer than its rest length, never pushes";

  double stiffness = 0.0;
  std::optional<double> rest_length = {};
  double damping = 0.0;
  std::optional<double> transition = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using base::Field;
    using base::Need;
    visit(Field{.key = "stiffness",
                .doc = "force a length of the taut cable; 0 makes a pure damper",
                .unit = base::dimension::stiffness,
                .range = base::non_negative},
          self.stiffness);
    visit(Field{.key = "rest_length",
                .doc = "longest length without force; the distance in the scene pose if not given",
                .unit = base::dimension::length,
                .range = base::non_negative,
                .need = Need::optional},
          self.rest_length);
    visit(Field{.key = "damping",
                .doc = "force a rate of the length of the taut cable",
                .unit = base::dimension::damping,
                .range = base::non_negative,
                .need = Need::optional},
          self.damping);
    visit(Field{.key = "transition",
                .doc = "elongation over which the cable tightens; default a hundredth of its rest length",
                .unit = base::dimension::length,
                .range = base::non_negative,
                .need = Need::optional},
          self.transition);
  }

  friend bool operator==(const CableSpring&, const CableSpring&) = default;

  /// The element between ends that are `distance` apart in the scene pose.
  Cable element(double distance) const {
    const double length = rest_length.value_or(distance);
    return {.stiffness = stiffness,
            .rest_length = length,
            .damping = damping,
            .transition = transition.value_or(0.01 * length)};
  }
};

}  // namespace muldi::muscles
