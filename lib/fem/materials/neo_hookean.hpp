#pragma once
/// Isochoric neo-Hookean elasticity (numerics 1.2, `ISO` without its volumetric energy).
#include <string_view>

#include "fem/materials/point.hpp"

namespace muldi::fem {

/// mu/2 (J^(-2/3) C:1 - 3).
struct NeoHookean {
  static constexpr std::string_view name = "neo_hookean";
  static constexpr std::string_view doc = "isochoric neo-Hookean elasticity: mu/2 (J^(-2/3) C:1 - 3)";

  double mu = 0.0;  ///< shear modulus

  template <class T>
  T energy(const Point<T>& at) const {
    const T root = inverse_cbrt(at.J);
    return 0.5 * mu * (root * root * at.trace_C() - 3.0);
  }

  template <class T>
  void add_stress(const Point<T>& at, Stress<T>& out) const {
    const T root = inverse_cbrt(at.J);
    const T a = mu * root * root;
    const T b = (-1.0 / 3.0) * a * at.trace_C();
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) out.P[i][k] = out.P[i][k] + (a * at.F[i][k] + b * at.f[k][i]);
  }

  template <class T>
  void add_tangent(const Point<T>& at, Tangent<T>& out) const {
    const T root = inverse_cbrt(at.J);
    const T a = mu * root * root;
    const T third = (1.0 / 3.0) * a * at.trace_C();
    // P = a F - third F^-T; da = -2/3 a F^-T, and F takes part of the terms in F^-T along.
    T h[3][3];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) h[i][k] = (-2.0 / 3.0) * a * at.F[i][k] + (1.0 / 3.0) * third * at.f[k][i];
    const auto& f = at.f;
    out.add_FF([&](auto i, auto k, auto j, auto l) __attribute__((always_inline)) {
      T entry = h[i][k] * f[l][j] + f[k][i] * h[j][l] + third * (f[k][j] * f[l][i]);
      if constexpr (i == j && k == l) entry = entry + a;
      return entry;
    });
  }
};

}  // namespace muldi::fem
