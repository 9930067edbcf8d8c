#pragma once
/// Isochoric elasticity with locking at a largest stretch (Gent, Rubber Chem. Technol. 69, 1996).
#include <string_view>

#include "fem/materials/point.hpp"

namespace muldi::fem {

/// -mu/2 J_m ln(1 - (J^(-2/3) C:1 - 3)/J_m); inadmissible where the argument is not positive.
struct Gent {
  static constexpr std::string_view name = "gent";
  static constexpr std::string_view doc =
      "isochoric elasticity that locks: -mu/2 J_m ln(1 - (J^(-2/3) C:1 - 3)/J_m), J_m the largest J^(-2/3) C:1 - 3";

  double mu = 0.0;   ///< shear modulus
  double J_m = 1.0;  ///< locking value of J^(-2/3) C:1 - 3

  template <class T>
  T energy(const Point<T>& at) const {
    using std::log;
    return -0.5 * mu * J_m * log(positive_or_one(margin(at)));
  }

  template <class T>
  void add_stress(const Point<T>& at, Stress<T>& out) const {
    const T left = margin(at);
    out.limit = lowered(out.limit, left);
    const T root = inverse_cbrt(at.J);
    const T a = mu * root * root / positive_or_one(left);
    const T b = (-1.0 / 3.0) * a * at.trace_C();
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) out.P[i][k] = out.P[i][k] + (a * at.F[i][k] + b * at.f[k][i]);
  }

  template <class T>
  void add_tangent(const Point<T>& at, Tangent<T>& out) const {
    const T left = positive_or_one(margin(at));
    const T root = inverse_cbrt(at.J);
    const T a = mu * root * root / left;
    const T third = (1.0 / 3.0) * a * at.trace_C();
    // The neo-Hookean tangent over the margin, and the dyad of the stress from the slope of the margin.
    const T c = 2.0 / (mu * J_m);
    T h[3][3];
    T P[3][3];
    const auto& f = at.f;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        h[i][k] = (-2.0 / 3.0) * a * at.F[i][k] + (1.0 / 3.0) * third * f[k][i];
        P[i][k] = a * at.F[i][k] - third * f[k][i];
      }
    }
    out.add_FF([&](auto i, auto k, auto j, auto l) __attribute__((always_inline)) {
      T entry = h[i][k] * f[l][j] + f[k][i] * h[j][l] + third * (f[k][j] * f[l][i]) + c * P[i][k] * P[j][l];
      if constexpr (i == j && k == l) entry = entry + a;
      return entry;
    });
  }

 private:
  template <class T>
  T margin(const Point<T>& at) const {
    const T root = inverse_cbrt(at.J);
    return 1.0 - (root * root * at.trace_C() - 3.0) * (1.0 / J_m);
  }
};

}  // namespace muldi::fem
