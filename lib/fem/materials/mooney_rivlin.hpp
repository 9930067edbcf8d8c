#pragma once
/// Isochoric elasticity of Mooney and Rivlin.
#include <string_view>

#include "fem/materials/point.hpp"

namespace muldi::fem {

/// mu_1/2 (J^(-2/3) I1 - 3) + mu_2/2 (J^(-4/3) I2 - 3), I1 = C:1, I2 = (I1^2 - C:C)/2; shear modulus mu_1 + mu_2.
struct MooneyRivlin {
  static constexpr std::string_view name = "mooney_rivlin";
  static constexpr std::string_view doc =
      "isochoric elasticity mu_1/2 (J^(-2/3) I1 - 3) + mu_2/2 (J^(-4/3) I2 - 3), shear modulus mu_1 + mu_2";

  double mu_1 = 0.0;
  double mu_2 = 0.0;

  template <class T>
  T energy(const Point<T>& at) const {
    const Invariants<T> of(at);
    const T root = inverse_cbrt(at.J);
    const T square = root * root;
    return 0.5 * mu_1 * (square * of.I1 - 3.0) + 0.5 * mu_2 * (square * square * of.I2 - 3.0);
  }

  template <class T>
  void add_stress(const Point<T>& at, Stress<T>& out) const {
    const Invariants<T> of(at);
    const T root = inverse_cbrt(at.J);
    const T a = mu_1 * root * root;
    const T b = mu_2 * (root * root) * (root * root);
    const T s = (-1.0 / 3.0) * (a * of.I1 + 2.0 * b * of.I2);
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        out.P[i][k] = out.P[i][k] + (a * at.F[i][k] + b * of.Y(at, i, k) + s * at.f[k][i]);
      }
    }
  }

  template <class T>
  void add_tangent(const Point<T>& at, Tangent<T>& out) const {
    const Invariants<T> of(at);
    const T root = inverse_cbrt(at.J);
    const T a = mu_1 * root * root;
    const T b = mu_2 * (root * root) * (root * root);
    const T third = (1.0 / 3.0) * a * of.I1;
    const T s = (2.0 / 3.0) * b * of.I2;
    const auto& F = at.F;
    const auto& f = at.f;
    T h[3][3];
    T B[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        h[i][k] =
            (-2.0 / 3.0) * a * F[i][k] - (4.0 / 3.0) * b * of.Y(at, i, k) + (third + 2.0 * s) * (1.0 / 3.0) * f[k][i];
        B[i][k] = F[i][0] * F[k][0] + F[i][1] * F[k][1] + F[i][2] * F[k][2];
      }
    }
    out.add_FF([&](auto i, auto k, auto j, auto l) __attribute__((always_inline)) {
      T entry = h[i][k] * f[l][j] + f[k][i] * h[j][l] + (third + s) * (f[k][j] * f[l][i]) +
                b * (2.0 * F[i][k] * F[j][l] - F[i][l] * F[j][k]);
      if constexpr (i == j) entry = entry - b * of.C[k][l];
      if constexpr (k == l) entry = entry - b * B[i][j];
      if constexpr (i == j && k == l) entry = entry + (a + b * of.I1);
      return entry;
    });
  }

 private:
  /// C and its first two invariants.
  template <class T>
  struct Invariants {
    T C[3][3];
    T I1;
    T I2;

    explicit Invariants(const Point<T>& at) {
      T square(0.0);
      for (int k = 0; k < 3; ++k) {
        for (int l = 0; l < 3; ++l) {
          C[k][l] = at.F[0][k] * at.F[0][l] + at.F[1][k] * at.F[1][l] + at.F[2][k] * at.F[2][l];
          square = square + C[k][l] * C[k][l];
        }
      }
      I1 = C[0][0] + C[1][1] + C[2][2];
      I2 = 0.5 * (I1 * I1 - square);
    }
    /// 1/2 dI2/dF = I1 F - F C.
    T Y(const Point<T>& at, int i, int k) const {
      return I1 * at.F[i][k] - (at.F[i][0] * C[0][k] + at.F[i][1] * C[1][k] + at.F[i][2] * C[2][k]);
    }
  };
};

}  // namespace muldi::fem
