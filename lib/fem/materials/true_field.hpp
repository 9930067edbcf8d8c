#pragma once
/// The energy (alpha J + beta) E.C^-1.E with its derivatives: the part that all electric laws share.
#include "fem/materials/point.hpp"

namespace muldi::fem {

/// The true field e = F^-T E and the vector c = C^-1 E at a point.
template <class T>
struct TrueField {
  T e[3];
  T c[3];
  T square;  ///< |e|^2 = E.C^-1.E

  explicit TrueField(const Point<T>& at) {
    for (int i = 0; i < 3; ++i) e[i] = at.f[0][i] * at.E[0] + at.f[1][i] * at.E[1] + at.f[2][i] * at.E[2];
    for (int k = 0; k < 3; ++k) c[k] = at.f[k][0] * e[0] + at.f[k][1] * e[1] + at.f[k][2] * e[2];
    square = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
  }
};

/// (C^-1)_kl, k <= l, filled on both sides.
template <class T>
void inverse_C(const Point<T>& at, T (&inverse)[3][3]) {
  for (int k = 0; k < 3; ++k) {
    for (int l = k; l < 3; ++l) {
      inverse[k][l] = at.f[k][0] * at.f[l][0] + at.f[k][1] * at.f[l][1] + at.f[k][2] * at.f[l][2];
      inverse[l][k] = inverse[k][l];
    }
  }
}

/// (alpha J + beta) |e|^2. The ideal dielectric has alpha = -eps/2; the part alpha J carries the Maxwell stress.
struct FieldEnergy {
  double alpha = 0.0;
  double beta = 0.0;

  template <class T>
  T energy(const Point<T>& at) const {
    return (alpha * at.J + beta) * TrueField<T>(at).square;
  }

  template <class T>
  void add_stress(const Point<T>& at, Stress<T>& out) const {
    const TrueField<T> field(at);
    const T volume = alpha * at.J;
    const T twice = -2.0 * (volume + beta);
    const T pressure = volume * field.square;
    for (int i = 0; i < 3; ++i) {
      const T scaled = twice * field.e[i];
      for (int k = 0; k < 3; ++k) {
        out.P[i][k] = out.P[i][k] + (scaled * field.c[k] + pressure * at.f[k][i]);
      }
    }
    for (int k = 0; k < 3; ++k) out.D[k] = out.D[k] + twice * field.c[k];
  }

  template <class T>
  void add_tangent(const Point<T>& at, Tangent<T>& out) const {
    const TrueField<T> field(at);
    const auto& f = at.f;
    const auto& e = field.e;
    const auto& c = field.c;
    const T volume = alpha * at.J;
    const T twice = 2.0 * (volume + beta);
    const T pressure = volume * field.square;
    T scaled_inverse[3][3];
    inverse_C(at, scaled_inverse);
    for (auto& row : scaled_inverse)
      for (T& entry : row) entry = twice * entry;
    // P = -twice e (x) c + pressure F^-T; what multiplies f_lj and f_ki, with the half of the term they share.
    T h[3][3];
    T s[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        const T dyad = e[i] * c[k];
        h[i][k] = 0.5 * pressure * f[k][i] - 2.0 * volume * dyad;
        s[i][k] = twice * dyad;
      }
    }
    out.add_FF([&](auto i, auto k, auto j, auto l) __attribute__((always_inline)) {
      return h[i][k] * f[l][j] + f[k][i] * h[j][l] + s[j][k] * f[l][i] + f[k][j] * (s[i][l] - pressure * f[l][i]) +
             scaled_inverse[k][l] * (e[i] * e[j]);
    });
    T g[3];
    for (int i = 0; i < 3; ++i) g[i] = twice * c[i];
    const T w = 2.0 * volume;
    out.add_FE([&](auto i, auto k, auto m) __attribute__((always_inline)) {
      return w * c[m] * f[k][i] - g[k] * f[m][i] - scaled_inverse[k][m] * e[i];
    });
    out.add_EE([&](auto k, auto m) __attribute__((always_inline)) { return scaled_inverse[k][m]; });
  }
};

}  // namespace muldi::fem
