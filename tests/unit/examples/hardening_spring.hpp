#pragma once
/// A spring that stiffens with its elongation x = z - z0: Pi = k/2 x^2 + h/4 x^4, so that its force is k x + h x^3.
#include <string_view>

#include "base/describe.hpp"
#include "muscles/axial.hpp"

namespace muldi::muscles {

/// The element: its energy and its other force as templates of the scalar; derivatives come from jets.
struct Hardening {
  static constexpr std::string_view folder = "springs";
  static constexpr std::string_view noun = "spring";
  static constexpr int n_controls = 0;

  double stiffness = 0.0;
  double hardening = 0.0;
  double rest_length = 0.0;

  template <class S>
  S elastic(const S& z) const {
    const S x = z - rest_length;
    return 0.5 * stiffness * x * x + 0.25 * hardening * x * x * x * x;
  }
  template <class S>
  S force(const S&, const S&, const Controls<S, 0>&) const {
    return S(0.0);
  }
  bool dissipates() const { return false; }
};

/// What a scene says of it beside its ends: springs: {s: {type: hardening, ...}}.
struct HardeningSpring {
  static constexpr std::string_view name = "hardening";
  static constexpr std::string_view doc = "a spring that stiffens: force k x + h x^3 of its elongation x";

  double stiffness = 0.0;
  double hardening = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "stiffness", .doc = "k", .unit = dimension::stiffness, .range = positive}, self.stiffness);
    visit(Field{.key = "hardening",
                .doc = "h",
                .unit = dimension::stiffness / dimension::area,
                .range = non_negative,
                .need = Need::optional},
          self.hardening);
  }

  friend bool operator==(const HardeningSpring&, const HardeningSpring&) = default;

  /// Without force in the scene pose, in which its ends are `distance` apart.
  Hardening element(double distance) const {
    return {.stiffness = stiffness, .hardening = hardening, .rest_length = distance};
  }
};

}  // namespace muldi::muscles
