#pragma once
/// The electric law of thesis chapters 4 and 5 (numerics 1.2, `vu`; its published parameters: numerics C1).
#include <string_view>

#include "fem/materials/true_field.hpp"

namespace muldi::fem {

/// c1 E.E + c2 E.C.E - 1/2 eps0 J E.C^-1.E.
struct Vu {
  static constexpr std::string_view name = "vu";
  static constexpr std::string_view doc =
      "electrostriction after Vu: energy c1 E.E + c2 E.C.E - eps0/2 J E.C^-1.E; kept to compare with older work";

  double c1 = 0.0;
  double c2 = 0.0;
  double eps0 = 0.0;  ///< permittivity of vacuum

  template <class T>
  T energy(const Point<T>& at) const {
    T w[3];
    deformed(at, w);
    const T squares = at.E[0] * at.E[0] + at.E[1] * at.E[1] + at.E[2] * at.E[2];
    return c1 * squares + c2 * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]) + vacuum().energy(at);
  }

  template <class T>
  void add_stress(const Point<T>& at, Stress<T>& out) const {
    T w[3];
    deformed(at, w);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) out.P[i][k] = out.P[i][k] + 2.0 * c2 * w[i] * at.E[k];
    for (int k = 0; k < 3; ++k) {
      const T C_E = at.F[0][k] * w[0] + at.F[1][k] * w[1] + at.F[2][k] * w[2];
      out.D[k] = out.D[k] - (2.0 * c1 * at.E[k] + 2.0 * c2 * C_E);
    }
    vacuum().add_stress(at, out);
  }

  template <class T>
  void add_tangent(const Point<T>& at, Tangent<T>& out) const {
    T w[3];
    deformed(at, w);
    const auto& F = at.F;
    const auto& E = at.E;
    const double c = 2.0 * c2;
    out.add_FF([&](auto i, auto k, auto j, auto l) __attribute__((always_inline)) {
      if constexpr (i == j) {
        return c * E[k] * E[l];
      } else {
        return 0.0;
      }
    });
    out.add_FE([&](auto i, auto k, auto m) __attribute__((always_inline)) {
      T entry = c * F[i][m] * E[k];
      if constexpr (k == m) entry = entry + c * w[i];
      return entry;
    });
    out.add_EE([&](auto k, auto m) __attribute__((always_inline)) {
      T entry = c * (F[0][k] * F[0][m] + F[1][k] * F[1][m] + F[2][k] * F[2][m]);
      if constexpr (k == m) entry = entry + 2.0 * c1;
      return entry;
    });
    vacuum().add_tangent(at, out);
  }

 private:
  FieldEnergy vacuum() const { return {.alpha = -0.5 * eps0, .beta = 0.0}; }

  /// w = F E.
  template <class T>
  static void deformed(const Point<T>& at, T (&w)[3]) {
    for (int i = 0; i < 3; ++i) w[i] = at.F[i][0] * at.E[0] + at.F[i][1] * at.E[1] + at.F[i][2] * at.E[2];
  }
};

}  // namespace muldi::fem
