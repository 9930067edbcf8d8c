#pragma once
/// The derivative of the viscous force by position at fixed velocity: not symmetric, for referees, not for speed.
#include "fem/kernel/batch.hpp"
#include "fem/kernel/law_calls.hpp"

namespace muldi::fem {

/// dN_a/dX_m at a Gauss point.
template <class L>
void shape_gradients(const ReferenceMap<L>& map, int q, L (&dN)[8][3]) {
  for (int a = 0; a < 8; ++a) {
    L unit[8];
    for (int b = 0; b < 8; ++b) unit[b] = L(a == b ? 1.0 : 0.0);
    const ReferenceGradient<L> of(unit);
    for (int m = 0; m < 3; ++m) dN[a][m] = map.gradient(of, q, m);
  }
}

/// A[3 i + k][3 j + l] = dP_ik/dF_jl of the viscous law, by duals.
template <class L>
void viscous_tangent(const LawReference& viscous, const Point<L>& at, L (&A)[9][9]) {
  using T = math::Dual<L>;
  for (int variable = 0; variable < 9; ++variable) {
    Point<T> seeded;
    for (int n = 0; n < 9; ++n) {
      seeded.F[n / 3][n % 3] = T(at.F[n / 3][n % 3], L(n == variable ? 1.0 : 0.0));
      seeded.F_rate[n / 3][n % 3] = T(at.F_rate[n / 3][n % 3]);
    }
    seeded.complete();
    Stress<T> stress{};
    LawCalls<T, ViscousLaws>::stress(viscous.type)(viscous.law, seeded, stress);
    for (int n = 0; n < 9; ++n) A[n][variable] = stress.P[n / 3][n % 3].slope;
  }
}

/// Adds dN_a : A : dN_b of one Gauss point to the matrices of the batch.
template <class L>
void add_viscous_point(const L (&A)[9][9], const L (&dN)[8][3], const L& factor, const Batch& batch, double* matrices) {
  for (int a = 0; a < 8; ++a) {
    for (int i = 0; i < 3; ++i) {
      L row[9];
      for (int jl = 0; jl < 9; ++jl) {
        row[jl] = factor * (dN[a][0] * A[3 * i][jl] + dN[a][1] * A[3 * i + 1][jl] + dN[a][2] * A[3 * i + 2][jl]);
      }
      for (int b = 0; b < 8; ++b) {
        for (int j = 0; j < 3; ++j) {
          const L entry = row[3 * j] * dN[b][0] + row[3 * j + 1] * dN[b][1] + row[3 * j + 2] * dN[b][2];
          const long to = 32 * (4 * corner_of_bits[a] + i) + 4 * corner_of_bits[b] + j;
          for (int lane = 0; lane < batch.active; ++lane) matrices[1024L * batch.elements[lane] + to] += entry[lane];
        }
      }
    }
  }
}

template <class L>
void viscous_by_position(const MaterialLaws& laws, const ElementRange& range, const ElementFields& fields,
                         double weight, double* matrices) {
  if (laws.viscous.type < 0 || fields.v == nullptr) return;
  for (int b = 0; b < range.n_batches; ++b) {
    const Batch batch(range, b, L::size);
    const GatheredFields<L> gathered_fields(fields, {}, batch);
    Point<L> at;
    for (int q = 0; q < 8; ++q) {
      const ReferenceMap<L> map(gathered_fields.X, q);
      gathered_fields.at(q, map, at);
      L A[9][9];
      viscous_tangent(laws.viscous, at, A);
      L dN[8][3];
      shape_gradients(map, q, dN);
      add_viscous_point(A, dN, weight * map.volume, batch, matrices);
    }
  }
}

}  // namespace muldi::fem
