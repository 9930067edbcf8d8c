#pragma once
/// Compressible neo-Hookean elasticity after Bonet and Wood (numerics 1.2, `BW`).
#include <string_view>

#include "fem/materials/point.hpp"

namespace muldi::fem {

/// mu/2 (C:1 - 3) - mu ln J + lambda/2 ln^2 J. Formulations with an element pressure set lambda = 0 and take the
/// volumetric energy from a volumetric law.
struct BonetWood {
  static constexpr std::string_view name = "bonet_wood";
  static constexpr std::string_view doc = "neo-Hookean elasticity: mu/2 (C:1 - 3) - mu ln J + lambda/2 ln^2 J";

  double mu = 0.0;      ///< shear modulus
  double lambda = 0.0;  ///< first constant of Lame

  template <class T>
  T energy(const Point<T>& at) const {
    using std::log;
    const T log_J = log(at.J);
    return 0.5 * mu * (at.trace_C() - 3.0) - mu * log_J + 0.5 * lambda * log_J * log_J;
  }

  template <class T>
  void add_stress(const Point<T>& at, Stress<T>& out) const {
    using std::log;
    const T b = lambda * log(at.J) - mu;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) out.P[i][k] = out.P[i][k] + (mu * at.F[i][k] + b * at.f[k][i]);
  }

  template <class T>
  void add_tangent(const Point<T>& at, Tangent<T>& out) const {
    using std::log;
    const T b = mu - lambda * log(at.J);
    const auto& f = at.f;
    out.add_FF([&](auto i, auto k, auto j, auto l) __attribute__((always_inline)) {
      T entry = lambda * (f[k][i] * f[l][j]) + b * (f[k][j] * f[l][i]);
      if constexpr (i == j && k == l) entry = entry + mu;
      return entry;
    });
  }
};

}  // namespace muldi::fem
