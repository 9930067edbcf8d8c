#pragma once
/// Viscous stress parallel to the elastic one (numerics 1.3).
#include <string_view>

#include "base/mutation.hpp"
#include "fem/materials/point.hpp"

namespace muldi::fem {

/// P = eta/2 J (F^-T dF/dt^T F^-T + dF/dt C^-1) = eta J d F^-T with d = sym(L), L = dF/dt F^-1.
/// The shear viscosity is eta/2. No energy: `dissipation` is the power P : dF/dt, and the tangent is by the rate.
struct KelvinVoigt {
  static constexpr std::string_view name = "kelvin_voigt";
  static constexpr std::string_view doc = "viscous stress parallel to the elastic one: Cauchy stress eta d";

  double viscosity = 0.0;  ///< eta

  /// eta J d:d, by reference volume.
  template <class T>
  T dissipation(const Point<T>& at) const {
    T d[3][3];
    deformation_rate(at, d);
    T sum(0.0);
    for (const auto& row : d)
      for (const T& entry : row) sum = sum + entry * entry;
    return viscosity * at.J * sum;
  }

  template <class T>
  void add_stress(const Point<T>& at, Stress<T>& out) const {
    T d[3][3];
    deformation_rate(at, d);
    const T factor = (base::times_missing_half() * viscosity) * at.J;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        out.P[i][k] = out.P[i][k] + factor * (d[i][0] * at.f[k][0] + d[i][1] * at.f[k][1] + d[i][2] * at.f[k][2]);
      }
    }
  }

  /// Adds weight dP/d(dF/dt), which is symmetric; the derivative by F is not, and left to duals.
  template <class T>
  void add_rate_tangent(const Point<T>& at, double weight, Tangent<T>& out) const {
    const T a = (0.5 * weight * viscosity) * at.J;
    const auto& f = at.f;
    T scaled[3][3];
    for (int k = 0; k < 3; ++k) {
      for (int l = k; l < 3; ++l) scaled[k][l] = a * (f[k][0] * f[l][0] + f[k][1] * f[l][1] + f[k][2] * f[l][2]);
    }
    out.add_FF([&](auto i, auto k, auto j, auto l) __attribute__((always_inline)) {
      T entry = a * (f[l][i] * f[k][j]);
      if constexpr (i == j) entry = entry + scaled[k][l];
      return entry;
    });
  }

 private:
  template <class T>
  static void deformation_rate(const Point<T>& at, T (&d)[3][3]) {
    T L[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        L[i][j] = at.F_rate[i][0] * at.f[0][j] + at.F_rate[i][1] * at.f[1][j] + at.F_rate[i][2] * at.f[2][j];
      }
    }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) d[i][j] = 0.5 * (L[i][j] + L[j][i]);
  }
};

}  // namespace muldi::fem
