#pragma once
/// Forward and backward substitution with one panel.
#include "math/sparse_kernel_vectors.hpp"

namespace muldi::math::kernels {
namespace {

/// w(row..) -= L(row.., j..j+columns-1) x(j..) for every right-hand side.
template <class Scalar, int columns, int sides>
inline void subtract_columns(const PanelSolve<Scalar>& s, int j, int row, Scalar* w) {
  using V = typename Vectors<Scalar>::V;
  constexpr int n = Vectors<Scalar>::n;
  V x[sides][columns];
  for (int r = 0; r < sides; ++r) {
    for (int c = 0; c < columns; ++c) x[r][c] = splat<Scalar>(w[r * s.w_stride + j + c]);
  }
  const Scalar* left = s.values + j * s.stride;
  const int end = static_cast<int>(s.stride);
  for (; row + n <= end; row += n) {
    V column[columns];
    for (int c = 0; c < columns; ++c) column[c] = load(left + c * s.stride + row);
    for (int r = 0; r < sides; ++r) {
      V y = load(w + r * s.w_stride + row);
      for (int c = 0; c < columns; ++c) y -= column[c] * x[r][c];
      store(w + r * s.w_stride + row, y);
    }
  }
  for (; row < end; ++row) {
    for (int r = 0; r < sides; ++r) {
      Scalar y = w[r * s.w_stride + row];
      for (int c = 0; c < columns; ++c) y -= left[c * s.stride + row] * x[r][c][0];
      w[r * s.w_stride + row] = y;
    }
  }
}

/// w(j..) -= L(row.., j..j+columns-1)^T w(row..) for every right-hand side.
template <class Scalar, int columns, int sides>
inline void subtract_dots(const PanelSolve<Scalar>& s, int j, int row, Scalar* w) {
  using V = typename Vectors<Scalar>::V;
  constexpr int n = Vectors<Scalar>::n;
  V sum[sides][columns] = {};
  Scalar rest[sides][columns] = {};
  const Scalar* left = s.values + j * s.stride;
  const int end = static_cast<int>(s.stride);
  for (; row + n <= end; row += n) {
    V column[columns];
    for (int c = 0; c < columns; ++c) column[c] = load(left + c * s.stride + row);
    for (int r = 0; r < sides; ++r) {
      const V y = load(w + r * s.w_stride + row);
      for (int c = 0; c < columns; ++c) sum[r][c] += column[c] * y;
    }
  }
  for (; row < end; ++row) {
    for (int r = 0; r < sides; ++r) {
      for (int c = 0; c < columns; ++c) rest[r][c] += left[c * s.stride + row] * w[r * s.w_stride + row];
    }
  }
  for (int r = 0; r < sides; ++r) {
    for (int c = 0; c < columns; ++c) {
      for (int i = 0; i < n; ++i) rest[r][c] += sum[r][c][i];
      w[r * s.w_stride + j + c] -= rest[r][c];
    }
  }
}

inline constexpr int solve_columns = 4;

template <class Scalar, int sides>
void forward_sides(const PanelSolve<Scalar>& s, Scalar* w) {
  int j = 0;
  for (; j + solve_columns <= s.k; j += solve_columns) {
    for (int r = 0; r < sides; ++r) {
      Scalar* x = w + r * s.w_stride + j;
      for (int c = 0; c < solve_columns; ++c) {
        const Scalar* column = s.values + (j + c) * s.stride + j;
        x[c] /= column[c];
        for (int i = c + 1; i < solve_columns; ++i) x[i] -= column[i] * x[c];
      }
    }
    subtract_columns<Scalar, solve_columns, sides>(s, j, j + solve_columns, w);
  }
  for (; j < s.k; ++j) {
    for (int r = 0; r < sides; ++r) w[r * s.w_stride + j] /= s.values[j * s.stride + j];
    subtract_columns<Scalar, 1, sides>(s, j, j + 1, w);
  }
  for (int r = 0; r < sides; ++r) {
    for (int i = 0; i < s.k; ++i) w[r * s.w_stride + i] *= static_cast<Scalar>(s.signs[i]);
  }
}

template <class Scalar, int sides>
void backward_sides(const PanelSolve<Scalar>& s, Scalar* w) {
  int j = s.k;
  for (; j % solve_columns != 0; --j) {
    subtract_dots<Scalar, 1, sides>(s, j - 1, j, w);
    for (int r = 0; r < sides; ++r) w[r * s.w_stride + j - 1] /= s.values[(j - 1) * s.stride + j - 1];
  }
  for (; j > 0; j -= solve_columns) {
    const int first = j - solve_columns;
    subtract_dots<Scalar, solve_columns, sides>(s, first, j, w);
    for (int r = 0; r < sides; ++r) {
      Scalar* x = w + r * s.w_stride + first;
      for (int c = solve_columns - 1; c >= 0; --c) {
        const Scalar* column = s.values + (first + c) * s.stride + first;
        for (int i = c + 1; i < solve_columns; ++i) x[c] -= column[i] * x[i];
        x[c] /= column[c];
      }
    }
  }
}

template <class Scalar>
void forward(const PanelSolve<Scalar>& s) {
  int r = 0;
  for (; r + 4 <= s.n_columns; r += 4) forward_sides<Scalar, 4>(s, s.w + r * s.w_stride);
  for (; r < s.n_columns; ++r) forward_sides<Scalar, 1>(s, s.w + r * s.w_stride);
}

template <class Scalar>
void backward(const PanelSolve<Scalar>& s) {
  int r = 0;
  for (; r + 4 <= s.n_columns; r += 4) backward_sides<Scalar, 4>(s, s.w + r * s.w_stride);
  for (; r < s.n_columns; ++r) backward_sides<Scalar, 1>(s, s.w + r * s.w_stride);
}

}  // namespace
}  // namespace muldi::math::kernels
