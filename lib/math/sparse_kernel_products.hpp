#pragma once
/// Products of symmetric block rows with a vector.
#include "math/sparse_kernel_vectors.hpp"

namespace muldi::math::kernels {
namespace {

template <class Scalar, int b>
inline auto load_node(const Scalar* p) {
  if constexpr (b == 4) {
    return load4(p);
  } else {
    return typename Vectors<Scalar>::V4{p[0], p[1], p[2], Scalar(0)};
  }
}

template <class Scalar, int b>
inline void store_node(Scalar* p, typename Vectors<Scalar>::V4 v) {
  if constexpr (b == 4) {
    store4(p, v);
  } else {
    for (int c = 0; c < 3; ++c) p[c] = v[c];
  }
}

/// Blocks of 3 or 4; a row of 3 is loaded with its right neighbour, whose lane is never stored.
template <class Scalar, int b>
void block_product(const BlockRows<Scalar>& a) {
  using V4 = typename Vectors<Scalar>::V4;
  for (int i = a.first_row; i < a.last_row; ++i) {
    const V4 x_i = load_node<Scalar, b>(a.x + static_cast<std::ptrdiff_t>(i) * b);
    V4 x_lane[b];
    V4 sum[b];
    int slot = a.row_start[i];
    const Scalar* block = a.values + static_cast<std::ptrdiff_t>(slot) * b * b;
    for (int r = 0; r < b; ++r) {
      x_lane[r] = splat4<Scalar>(x_i[r]);
      sum[r] = load4(block + r * b) * x_i;
    }
    for (++slot; slot < a.row_start[i + 1]; ++slot) {
      const std::ptrdiff_t j = a.columns[slot];
      block += b * b;
      const V4 x_j = load_node<Scalar, b>(a.x + j * b);
      Scalar* out = a.strip + (j - a.first_row) * b;
      V4 y_j = load_node<Scalar, b>(out);
      for (int r = 0; r < b; ++r) {
        const V4 row = load4(block + r * b);
        sum[r] += row * x_j;
        y_j += row * x_lane[r];
      }
      store_node<Scalar, b>(out, y_j);
    }
    Scalar* out = a.strip + static_cast<std::ptrdiff_t>(i - a.first_row) * b;
    for (int r = 0; r < b; ++r) {
      Scalar total = (sum[r][0] + sum[r][1]) + sum[r][2];
      if constexpr (b == 4) total += sum[r][3];
      out[r] += total;
    }
  }
}

/// Blocks of 1 or 2.
template <class Scalar, int b>
void small_block_product(const BlockRows<Scalar>& a) {
  for (int i = a.first_row; i < a.last_row; ++i) {
    const Scalar* x_i = a.x + static_cast<std::ptrdiff_t>(i) * b;
    Scalar* y_i = a.strip + static_cast<std::ptrdiff_t>(i - a.first_row) * b;
    for (int slot = a.row_start[i]; slot < a.row_start[i + 1]; ++slot) {
      const std::ptrdiff_t j = a.columns[slot];
      const Scalar* block = a.values + static_cast<std::ptrdiff_t>(slot) * b * b;
      const Scalar* x_j = a.x + j * b;
      Scalar* y_j = a.strip + (j - a.first_row) * b;
      for (int r = 0; r < b; ++r) {
        for (int c = 0; c < b; ++c) {
          y_i[r] += block[r * b + c] * x_j[c];
          if (j != i) y_j[c] += block[r * b + c] * x_i[r];
        }
      }
    }
  }
}

}  // namespace
}  // namespace muldi::math::kernels
