#pragma once
/// Element matrices to where they belong: blocks of a sparse matrix, or dense matrices.
#include "fem/kernel/tangent.hpp"

namespace muldi::fem {

/// Entry (a, i), (b, j) of the matrices of a batch.
template <class L>
[[gnu::always_inline]] inline L& entry_of(TangentBatch<L>& batch, int a, int i, int b, int j) {
  return i <= j ? batch.K[Tangent<L>::pair(i, j)][8 * a + b] : batch.K[Tangent<L>::pair(j, i)][8 * b + a];
}

/// Zeroes the rows and columns of fixed unknowns, if there are any.
template <class L>
void leave_out_fixed(const std::uint8_t* fixed, const Batch& batch, int n_fields, TangentBatch<L>& work) {
  unsigned any = 0;
  for (int n = 0; n < 8 * L::size; ++n) any |= fixed[batch.nodes[n]];
  if (any == 0) return;
  L keep[4][8];
  for (int i = 0; i < n_fields; ++i) {
    for (int a = 0; a < 8; ++a) {
      for (int lane = 0; lane < L::size; ++lane) {
        keep[i][a].set(lane, ((fixed[batch.nodes[a * L::size + lane]] >> i) & 1) != 0 ? 0.0 : 1.0);
      }
    }
  }
  for (int i = 0; i < n_fields; ++i) {
    for (int j = i; j < n_fields; ++j) {
      L* K = work.K[Tangent<L>::pair(i, j)];
      for (int ab = 0; ab < 64; ++ab) K[ab] = K[ab] * (keep[i][ab / 8] * keep[j][ab % 8]);
    }
  }
}

/// Adds values e = 0 .. n - 1 of each lane to the n consecutive numbers at target[lane].
template <int n, class L>
[[gnu::always_inline]] inline void add_blocks(L (&x)[n], double* const (&target)[L::size], int active) {
  constexpr int groups = n / L::size;
  for (int group = 0; group < groups; ++group) {
    L part[L::size];
    for (int e = 0; e < L::size; ++e) part[e] = x[group * L::size + e];
    transpose(part);
    for (int lane = 0; lane < active; ++lane) {
      double* to = target[lane] + group * L::size;
      (L::load(to) + part[lane]).store(to);
    }
  }
  for (int e = groups * L::size; e < n; ++e)
    for (int lane = 0; lane < active; ++lane) target[lane][e] += x[e][lane];
}

/// Asks for the blocks of one pair of corners early: the addresses jump, so the processor does not guess them, and the
/// scatter waits for memory more than it computes.
template <int block, class L>
[[gnu::always_inline]] inline void prefetch_blocks(const std::int32_t* slots, double* values) {
  constexpr int line = 8;
  for (int lane = 0; lane < L::size; ++lane) {
    double* const first = values + static_cast<long>(block * block) * (slots[lane] >> 1);
    for (int entry = 0; entry < block * block; entry += line) __builtin_prefetch(first + entry, 1, 3);
  }
}

/// Adds the blocks of all pairs of corners a <= b.
template <int block, class L>
void add_to_matrix(TangentBatch<L>& work, const Batch& batch, const BlockTarget& to) {
  const std::int32_t* slots = to.slots + 36L * L::size * batch.index;
  constexpr int ahead = 12;
  const std::int32_t* const last = slots + (36 - ahead) * L::size;
  for (int a = 0; a < 8; ++a) {
    for (int b = a; b < 8; ++b, slots += L::size) {
      if (slots < last) prefetch_blocks<block, L>(slots + ahead * L::size, to.values);
      double* target[L::size];
      typename L::Bits transposed;
      for (int lane = 0; lane < L::size; ++lane) {
        target[lane] = to.values + static_cast<long>(block * block) * (slots[lane] >> 1);
        transposed[lane] = -static_cast<std::int64_t>(slots[lane] & 1);
      }
      L x[block * block];
      for (int i = 0; i < block; ++i) {
        x[block * i + i] = entry_of(work, a, i, b, i);
        for (int j = i + 1; j < block; ++j) {
          const L upper = entry_of(work, a, i, b, j);
          const L lower = entry_of(work, a, j, b, i);
          x[block * i + j] = L::choose(transposed, lower, upper);
          x[block * j + i] = L::choose(transposed, upper, lower);
        }
      }
      add_blocks(x, target, batch.active);
    }
  }
}

template <class L>
void tangent(const MaterialLaws& laws, const ElementRange& range, const ElementFields& fields,
             const ElementTangentWeights& weights, const BlockTarget& to) {
  const TangentTask<L> task(laws, fields, weights);
  TangentBatch<L> work;
  for (int b = 0; b < range.n_batches; ++b) {
    const Batch batch(range, b, L::size);
    work.integrate(task, batch, to.block);
    if (to.fixed != nullptr) leave_out_fixed(to.fixed, batch, to.block, work);
    if (to.block == 4) {
      add_to_matrix<4>(work, batch, to);
    } else {
      add_to_matrix<3>(work, batch, to);
    }
  }
}

template <class L>
void dense(const MaterialLaws& laws, const ElementRange& range, const ElementFields& fields,
           const ElementTangentWeights& weights, double* matrices) {
  const TangentTask<L> task(laws, fields, weights);
  TangentBatch<L> work;
  for (int b = 0; b < range.n_batches; ++b) {
    const Batch batch(range, b, L::size);
    work.integrate(task, batch, 4);
    for (int row = 0; row < 32; ++row) {
      for (int column = 0; column < 32; ++column) {
        const L& entry = entry_of(work, row / 4, row % 4, column / 4, column % 4);
        const long to = 32 * (4 * corner_of_bits[row / 4] + row % 4) + 4 * corner_of_bits[column / 4] + column % 4;
        scatter_element(entry, batch, 1024, to, matrices);
      }
    }
  }
}

}  // namespace muldi::fem
