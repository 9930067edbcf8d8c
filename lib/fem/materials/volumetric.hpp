#pragma once
/// What all volumetric laws share: derivatives by F of an energy U(J) that a law gives with U' and U''.
///
/// Formulations with an element pressure evaluate U at the element's mean dilatation instead; they use U, dU_dJ and
/// d2U_dJdJ directly.
#include "fem/materials/point.hpp"

namespace muldi::fem {

template <class Law, class T>
void add_volumetric_stress(const Law& law, const Point<T>& at, Stress<T>& out) {
  const T a = law.dU_dJ(at.J) * at.J;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) out.P[i][k] = out.P[i][k] + a * at.f[k][i];
}

template <class Law, class T>
void add_volumetric_tangent(const Law& law, const Point<T>& at, Tangent<T>& out) {
  const T a = law.dU_dJ(at.J) * at.J;
  const T b = law.d2U_dJdJ(at.J) * at.J * at.J + a;
  const auto& f = at.f;
  out.add_FF([&](auto i, auto k, auto j, auto l)
                 __attribute__((always_inline)) { return b * (f[k][i] * f[l][j]) - a * (f[k][j] * f[l][i]); });
}

}  // namespace muldi::fem
