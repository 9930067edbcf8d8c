#pragma once
/// The trilinear hexahedron in modes: sums over nodes and Gauss points become Walsh transforms.
///
/// With nodes a and Gauss points q numbered by three bits (bit k set: coordinate k positive), a field is
/// sum_m c_m xi^m1 eta^m2 zeta^m3, m the bits of the mode, c = H x / 8 with the Walsh matrix H. At the Gauss points
/// xi_k = +-g, so derivatives by reference coordinates are sums with signs of c_m g^(|m| - 1): additions only. The
/// derivative along k does not depend on xi_k: four values a direction instead of eight.
#include "fem/materials/point.hpp"

namespace muldi::fem {

inline constexpr double gauss = 0.57735026918962576450914878;  ///< 1/sqrt(3)

/// The corner of VTK's order (fem/mesh/mesh.hpp) with the bits of the index.
inline constexpr int corner_of_bits[8] = {0, 1, 3, 2, 4, 5, 7, 6};

/// g^n.
constexpr double gauss_power(int n) {
  constexpr double powers[] = {1.0, gauss, 1.0 / 3.0, gauss / 3.0, 1.0 / 9.0, gauss / 9.0, 1.0 / 27.0};
  return powers[n];
}
constexpr int count_bits(int m) { return (m & 1) + ((m >> 1) & 1) + ((m >> 2) & 1); }

/// Index without bit k, 0..3.
constexpr int without_bit(int q, int k) { return k == 0 ? q >> 1 : k == 1 ? (q & 1) | ((q >> 1) & 2) : q & 3; }

/// x_w <- sum_q s_q^w x_q, where s_q^w = (-1)^(number of bits set in w and clear in q).
template <class T>
[[gnu::always_inline]] inline void walsh4(T (&x)[4]) {
  // Index 1 is the positive side: its difference has the sign x_1 - x_0.
  const T sum0 = x[1] + x[0];
  const T difference0 = x[1] - x[0];
  const T sum1 = x[3] + x[2];
  const T difference1 = x[3] - x[2];
  x[0] = sum1 + sum0;
  x[1] = difference1 + difference0;
  x[2] = sum1 - sum0;
  x[3] = difference1 - difference0;
}

/// The same for eight values at any distance.
template <class T>
[[gnu::always_inline]] inline void walsh8(T* x, int stride = 1) {
  T low[4] = {x[0], x[stride], x[2 * stride], x[3 * stride]};
  T high[4] = {x[4 * stride], x[5 * stride], x[6 * stride], x[7 * stride]};
  walsh4(low);
  walsh4(high);
  for (int w = 0; w < 4; ++w) {
    x[w * stride] = high[w] + low[w];
    x[(4 + w) * stride] = high[w] - low[w];
  }
}

/// x_q <- sum_w s_q^w x_w: the transposed transform.
template <class T>
[[gnu::always_inline]] inline void walsh4_transposed(T (&x)[4]) {
  const T sum0 = x[0] + x[1];
  const T difference0 = x[0] - x[1];
  const T sum1 = x[2] + x[3];
  const T difference1 = x[2] - x[3];
  x[0] = difference0 - difference1;
  x[1] = sum0 - sum1;
  x[2] = difference0 + difference1;
  x[3] = sum0 + sum1;
}
template <class T>
[[gnu::always_inline]] inline void walsh8_transposed(T* x, int stride = 1) {
  T low[4] = {x[0], x[stride], x[2 * stride], x[3 * stride]};
  T high[4] = {x[4 * stride], x[5 * stride], x[6 * stride], x[7 * stride]};
  walsh4_transposed(low);
  walsh4_transposed(high);
  for (int q = 0; q < 4; ++q) {
    x[q * stride] = low[q] - high[q];
    x[(4 + q) * stride] = low[q] + high[q];
  }
}

/// Derivatives by reference coordinates at the Gauss points: [k][without_bit(q, k)].
template <class T>
struct ReferenceGradient {
  T d[3][4];

  ReferenceGradient() = default;
  /// From nodal values (8), which it transforms.
  [[gnu::always_inline]] explicit ReferenceGradient(T (&x)[8]) {
    walsh8(x);
    unroll<3>([&](auto k) {
      T(&at)[4] = d[k];
      unroll<8>([&](auto m) {
        if constexpr (((m >> k) & 1) != 0) at[without_bit(m, k)] = (gauss_power(count_bits(m) - 1) / 8.0) * x[m];
      });
      walsh4_transposed(at);
    });
  }

  const T& at(int q, int k) const { return d[k][without_bit(q, k)]; }
};

/// Sums stresses by reference coordinates to nodal forces: the transpose of ReferenceGradient.
template <class T>
struct ReferenceDivergence {
  T d[3][4];

  [[gnu::always_inline]] void set_zero() {
    for (auto& row : d)
      for (T& entry : row) entry = T(0.0);
  }
  [[gnu::always_inline]] void add(int q, int k, const T& value) {
    T& to = d[k][without_bit(q, k)];
    to = to + value;
  }
  /// sum_q sum_k dN_a/dxi_k value_k, a = 0..7.
  [[gnu::always_inline]] void nodal(T (&x)[8]) {
    for (T& entry : x) entry = T(0.0);
    unroll<3>([&](auto k) {
      walsh4(d[k]);
      unroll<8>([&](auto m) {
        if constexpr (((m >> k) & 1) != 0) x[m] = x[m] + d[k][without_bit(m, k)];
      });
    });
    unroll<8>([&](auto m) {
      if constexpr (m > 0) x[m] = (gauss_power(count_bits(m) - 1) / 8.0) * x[m];
    });
    walsh8_transposed(x);
  }
};

/// Nodal values (8) to values at the Gauss points, in place.
template <class T>
[[gnu::always_inline]] inline void to_gauss_points(T (&x)[8]) {
  walsh8(x);
  unroll<8>([&](auto m) { x[m] = (gauss_power(count_bits(m)) / 8.0) * x[m]; });
  walsh8_transposed(x);
}

/// Values at the Gauss points to sum_q N_a(q) x_q, in place: the same matrix, since N_a(q) is symmetric in a and q.
template <class T>
[[gnu::always_inline]] inline void to_nodes(T (&x)[8]) {
  to_gauss_points(x);
}

/// inverse[k][m] = dxi_k/dX_m and the weighted volume of one Gauss point from dX_m/dxi_k; the weights are 1.
template <class T>
struct ReferenceMap {
  T inverse[3][3];
  T volume;

  [[gnu::always_inline]] ReferenceMap(const ReferenceGradient<T> (&X)[3], int q) {
    T G[3][3];
    for (int m = 0; m < 3; ++m)
      for (int k = 0; k < 3; ++k) G[m][k] = X[m].at(q, k);
    volume = adjugate(G, inverse);
    const T factor = 1.0 / volume;
    for (auto& row : inverse)
      for (T& entry : row) entry = factor * entry;
  }

  /// Derivative along X_m from those along xi_k.
  template <class S>
  [[gnu::always_inline]] S gradient(const ReferenceGradient<S>& field, int q, int m) const {
    return field.at(q, 0) * inverse[0][m] + field.at(q, 1) * inverse[1][m] + field.at(q, 2) * inverse[2][m];
  }
};

}  // namespace muldi::fem
