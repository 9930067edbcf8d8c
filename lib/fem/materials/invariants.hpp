#pragma once
/// Stretch-dependent permittivity (numerics 1.2, `I-law`; thesis 7.1.2).
#include <string_view>

#include "fem/materials/true_field.hpp"

namespace muldi::fem {

/// c1 I3 + c2 I4 + c3 I5 - 1/2 eps0 J I4 with I3 = E.E, I4 = E.C^-1.E, I5 = E.C^-2.E.
struct Invariants {
  static constexpr std::string_view name = "invariants";
  static constexpr std::string_view doc =
      "stretch-dependent permittivity: energy c1 E.E + c2 E.C^-1.E + c3 E.C^-2.E - eps0/2 J E.C^-1.E";

  double c1 = 0.0;
  double c2 = 0.0;
  double c3 = 0.0;
  double eps0 = 0.0;  ///< permittivity of vacuum

  template <class T>
  T energy(const Point<T>& at) const {
    const TrueField<T> field(at);
    const auto& c = field.c;
    const T I3 = at.E[0] * at.E[0] + at.E[1] * at.E[1] + at.E[2] * at.E[2];
    const T I5 = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
    return c1 * I3 + c2 * field.square + c3 * I5 - 0.5 * eps0 * at.J * field.square;
  }

  template <class T>
  void add_stress(const Point<T>& at, Stress<T>& out) const {
    field_energy().add_stress(at, out);
    const TrueField<T> field(at);
    const Twice<T> twice(at, field);
    const double factor = -2.0 * c3;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        out.P[i][k] = out.P[i][k] + factor * (field.e[i] * twice.b[k] + twice.h[i] * field.c[k]);
      }
    }
    for (int k = 0; k < 3; ++k) out.D[k] = out.D[k] + (factor * twice.b[k] - 2.0 * c1 * at.E[k]);
  }

  template <class T>
  void add_tangent(const Point<T>& at, Tangent<T>& out) const {
    field_energy().add_tangent(at, out);
    const TrueField<T> field(at);
    const Twice<T> twice(at, field);
    T inverse[3][3];
    T B[3][3];
    T M[3][3];
    T inverse2[3][3];
    inverse_C(at, inverse);
    products(at, inverse, M, inverse2);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) B[i][j] = at.f[0][i] * at.f[0][j] + at.f[1][i] * at.f[1][j] + at.f[2][i] * at.f[2][j];
    const double factor = -2.0 * c3;
    const auto& f = at.f;
    const auto& e = field.e;
    const auto& c = field.c;
    const auto& h = twice.h;
    const auto& b = twice.b;
    out.add_FF([&](auto i, auto k, auto j, auto l) __attribute__((always_inline)) {
      const T dh = h[j] * f[l][i] + B[i][j] * c[l] + M[i][l] * e[j];
      const T dc = f[k][j] * c[l] + inverse[k][l] * e[j];
      const T db = f[k][j] * b[l] + inverse[k][l] * h[j] + M[j][k] * c[l] + inverse2[k][l] * e[j];
      const T de = e[j] * f[l][i];
      return -factor * (dh * c[k] + h[i] * dc + db * e[i] + b[k] * de);
    });
    out.add_FE([&](auto i, auto k, auto m) __attribute__((always_inline)) {
      return factor * (M[i][m] * c[k] + h[i] * inverse[k][m] + inverse2[k][m] * e[i] + b[k] * f[m][i]);
    });
    out.add_EE([&](auto k, auto m) __attribute__((always_inline)) {
      T entry = -factor * inverse2[k][m];
      if constexpr (k == m) entry = entry + 2.0 * c1;
      return entry;
    });
  }

 private:
  FieldEnergy field_energy() const { return {.alpha = -0.5 * eps0, .beta = c2}; }

  /// h = F^-T C^-1 E and b = C^-2 E.
  template <class T>
  struct Twice {
    T h[3];
    T b[3];
    Twice(const Point<T>& at, const TrueField<T>& field) {
      const auto& f = at.f;
      for (int i = 0; i < 3; ++i) h[i] = f[0][i] * field.c[0] + f[1][i] * field.c[1] + f[2][i] * field.c[2];
      for (int k = 0; k < 3; ++k) b[k] = f[k][0] * h[0] + f[k][1] * h[1] + f[k][2] * h[2];
    }
  };

  /// M = F^-T C^-1 and C^-2.
  template <class T>
  static void products(const Point<T>& at, const T (&inverse)[3][3], T (&M)[3][3], T (&inverse2)[3][3]) {
    for (int i = 0; i < 3; ++i) {
      for (int l = 0; l < 3; ++l) {
        M[i][l] = at.f[0][i] * inverse[0][l] + at.f[1][i] * inverse[1][l] + at.f[2][i] * inverse[2][l];
        inverse2[i][l] = inverse[i][0] * inverse[0][l] + inverse[i][1] * inverse[1][l] + inverse[i][2] * inverse[2][l];
      }
    }
  }
};

}  // namespace muldi::fem
