#pragma once
/// Sums the tangents of the Gauss points to element matrices, one pair of fields (rows of (F; grad phi)) at a time.
#include "fem/kernel/hexahedron.hpp"

namespace muldi::fem {

/// Second derivatives by reference gradients of one pair of fields: entry 3 k + l at the Gauss points, weighted.
template <class L>
struct PairTangent {
  L entry[9][8];
};

/// hat_kl = factor volume sum_mn (dxi_k/dX_m) A_mn (dxi_l/dX_n); of a symmetric pair only k <= l is read and written.
template <bool symmetric, class L>
[[gnu::always_inline]] inline void pull_back(const L (&A)[9], const ReferenceMap<L>& map, const L& factor, int q,
                                             PairTangent<L>& hat) {
  const auto& R = map.inverse;
  for (int k = 0; k < 3; ++k) {
    L half[3];
    const L weight[3] = {factor * R[k][0], factor * R[k][1], factor * R[k][2]};
    for (int n = 0; n < 3; ++n) {
      half[n] = L(0.0);
      for (int m = 0; m < 3; ++m) {
        const int at = symmetric && m > n ? 3 * n + m : 3 * m + n;
        half[n] = half[n] + weight[m] * A[at];
      }
    }
    for (int l = symmetric ? k : 0; l < 3; ++l) {
      hat.entry[3 * k + l][q] = half[0] * R[l][0] + half[1] * R[l][1] + half[2] * R[l][2];
    }
  }
}

/// Entry (m, n) of the pair's matrix over modes: sum over k in m and l in n of the Walsh coefficient whose signs are
/// those of both derivatives.
template <int m, int n, bool symmetric, class L>
[[gnu::always_inline]] inline L modal_entry(const PairTangent<L>& t) {
  L sum(0.0);
  bool first = true;
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 3; ++l) {
      if (((m >> k) & 1) == 0 || ((n >> l) & 1) == 0) continue;
      const int at = symmetric && k > l ? 3 * l + k : 3 * k + l;
      const L& term = t.entry[at][(m ^ (1 << k)) ^ (n ^ (1 << l))];
      sum = first ? term : sum + term;
      first = false;
    }
  }
  return (gauss_power(count_bits(m) + count_bits(n) - 2) / 64.0) * sum;
}

/// Matrix (8, 8) over modes from the tangents at the Gauss points, which become their Walsh coefficients.
template <bool symmetric, class L>
void modal_matrix(PairTangent<L>& t, L (&K)[64]) {
  for (int kl = 0; kl < 9; ++kl) {
    if (!symmetric || kl / 3 <= kl % 3) walsh8(t.entry[kl]);
  }
  for (int m = 0; m < 8; ++m) {
    K[m] = L(0.0);
    K[8 * m] = L(0.0);
  }
  unroll<49>([&](auto mn) __attribute__((always_inline)) {
    constexpr int m = mn / 7 + 1;
    constexpr int n = mn % 7 + 1;
    if constexpr (!symmetric || m <= n) {
      K[8 * m + n] = modal_entry<m, n, symmetric>(t);
      if constexpr (symmetric && m < n) K[8 * n + m] = K[8 * m + n];
    }
  });
}

/// Adds the matrix over modes of sum_q weight_q N_a N_b, weight given by its Walsh coefficients.
template <class L>
void add_modal_mass(const L (&weight)[8], L (&K)[64]) {
  unroll<64>([&](auto mn) __attribute__((always_inline)) {
    constexpr int m = mn / 8;
    constexpr int n = mn % 8;
    K[mn] = K[mn] + (gauss_power(count_bits(m) + count_bits(n)) / 64.0) * weight[m ^ n];
  });
}

/// Matrix over modes to matrix over nodes, in place.
template <class L>
void modes_to_nodes(L (&K)[64]) {
  for (int m = 0; m < 8; ++m) walsh8_transposed(K + 8 * m);
  for (int b = 0; b < 8; ++b) walsh8_transposed(K + b, 8);
}

}  // namespace muldi::fem
