#pragma once
/// L S L^T of the pivot columns of a front, and the update of the rest.
#include "math/sparse_kernel_vectors.hpp"

namespace muldi::math::kernels {
namespace {

struct Tile {
  const double* a;  // rows of A, `a_stride` from column to column
  std::ptrdiff_t a_stride;
  const double* b;  // packed: tile_columns values for each depth, sign changed
  int depth;
  double* c;
  std::ptrdiff_t c_stride;
  int columns;  // of C, <= tile_columns
};

template <int vectors, bool add>
inline void multiply_tile(const Tile& t) {
  VectorD sum[tile_columns][vectors] = {};
  const double* a = t.a;
  const double* b = t.b;
  for (int p = 0; p < t.depth; ++p, a += t.a_stride, b += tile_columns) {
    VectorD left[vectors];
    for (int v = 0; v < vectors; ++v) left[v] = load(a + v * lanes);
    for (int c = 0; c < tile_columns; ++c) {
      const VectorD right = splat(b[c]);
      for (int v = 0; v < vectors; ++v) sum[c][v] += left[v] * right;
    }
  }
  for (int c = 0; c < tile_columns; ++c) {
    if (c >= t.columns) break;
    for (int v = 0; v < vectors; ++v) {
      double* out = t.c + c * t.c_stride + v * lanes;
      store(out, add ? load(out) + sum[c][v] : sum[c][v]);
    }
  }
}

template <bool add>
inline void multiply_tile_of(int vectors, const Tile& t) {
  if (vectors >= tile_vectors) {
    multiply_tile<tile_vectors, add>(t);
  } else if (vectors == 2) {
    multiply_tile<2, add>(t);
  } else {
    multiply_tile<1, add>(t);
  }
}

/// Columns c0..c1-1 of C from their aligned diagonal row on: C(r, c) -= sum over p0 <= p < p1 of L(r, p) s(p) L(c, p).
struct Update {
  int p0, p1;
  int c0, c1;
  double* target;         // where the entry (rounded_down(c0), c0) lies
  std::ptrdiff_t stride;  // of C
};

/// For each group of columns and each depth: -s(p) L(c, p), c in the group; zero beyond the last column.
inline void pack_right(const Panel& panel, const Update& u, int p0, int p1, double* out) {
  for (int c = u.c0; c < u.c1; c += tile_columns) {
    const int n = smaller(tile_columns, u.c1 - c);
    for (int p = p0; p < p1; ++p, out += tile_columns) {
      const double* column = panel.values + p * panel.stride + c;
      const double sign = -panel.signs[p];
      if (n == tile_columns) {
        for (int v = 0; v < tile_columns; v += lanes) store(out + v, load(column + v) * splat(sign));
      } else {
        for (int i = 0; i < tile_columns; ++i) out[i] = i < n ? column[i] * sign : 0.0;
      }
    }
  }
}

/// Rows of the columns p0..p1-1.
struct RowBlock {
  int row, n_rows;
  int p0, p1;
};

inline void pack_left(const Panel& panel, const RowBlock& block, double* out) {
  for (int tile = 0; tile < block.n_rows; tile += tile_rows) {
    const int n = smaller(tile_rows, block.n_rows - tile);
    for (int p = block.p0; p < block.p1; ++p, out += tile_rows) {
      const double* column = panel.values + p * panel.stride + block.row + tile;
      for (int v = 0; v < n; v += lanes) store(out + v, load(column + v));
    }
  }
}

/// One depth block of an update; `packs`: copies A first, which pays where it is used for many columns.
template <bool add>
void update_depth(const Panel& panel, const Update& u, int p0, int p1) {
  double* const packed_left = panel.pack + panel.thread_number() * pack_size;
  double* const packed_right = packed_left + pack_rows * pack_depth;
  pack_right(panel, u, p0, p1, packed_right);
  const int depth = p1 - p0;
  const bool packs = u.c1 - u.c0 > 3 * tile_columns;
  const int end = rounded_up(panel.m);
  const int first = rounded_down(u.c0);
  for (int block = first; block < end; block += pack_rows) {
    const int block_end = smaller(block + pack_rows, end);
    if (packs) pack_left(panel, {block, block_end - block, p0, p1}, packed_left);
    const double* right = packed_right;
    for (int c = u.c0; c < u.c1 && c < block_end; c += tile_columns, right += depth * tile_columns) {
      const int above = c > block ? (c - block) / tile_rows * tile_rows : 0;
      for (int row = block + above; row < block_end; row += tile_rows) {
        const double* left = packs ? packed_left + static_cast<std::ptrdiff_t>(row - block) * depth
                                   : panel.values + p0 * panel.stride + row;
        const Tile tile{
            left,     packs ? tile_rows : panel.stride, right, depth, u.target + (c - u.c0) * u.stride + (row - first),
            u.stride, smaller(tile_columns, u.c1 - c)};
        multiply_tile_of<add>((block_end - row) / lanes, tile);
      }
    }
  }
}

/// An update in chunks of columns, which write different columns and pack into the buffers of their thread.
template <bool overwrite>
struct ChunkedUpdate {
  const Panel& panel;
  const Update& whole;

  static void run_chunk(void* context, int chunk) {
    const ChunkedUpdate& self = *static_cast<const ChunkedUpdate*>(context);
    const Update& whole = self.whole;
    const int shift = chunk * chunk_columns;  // a multiple of row_multiple: rows stay aligned
    const Update u{whole.p0,
                   whole.p1,
                   whole.c0 + shift,
                   smaller(whole.c0 + shift + chunk_columns, whole.c1),
                   whole.target + shift * whole.stride + shift,
                   whole.stride};
    for (int p = u.p0; p < u.p1; p += pack_depth) {
      const int end = smaller(p + pack_depth, u.p1);
      if (overwrite && p == u.p0) {
        update_depth<false>(self.panel, u, p, end);
      } else {
        update_depth<true>(self.panel, u, p, end);
      }
    }
  }

  void run() {
    const int n_chunks = (whole.c1 - whole.c0 + chunk_columns - 1) / chunk_columns;
    if (n_chunks == 1) {
      run_chunk(this, 0);
    } else {
      panel.run_chunks(n_chunks, run_chunk, this);
    }
  }
};

// ---- L S L^T of a panel

/// The columns j0..j0+n-1 (n <= 8): the small triangle, then the rows below it.
inline int factor_corner(const Panel& panel, int j0, int n, double (&scaled)[8][8], double (&inverse)[8]) {
  for (int j = 0; j < n; ++j) {
    double* column = panel.values + (j0 + j) * panel.stride + j0;
    double pivot = column[j];
    for (int p = 0; p < j; ++p) pivot -= scaled[j][p] * panel.values[(j0 + p) * panel.stride + j0 + j];
    const double size = __builtin_fabs(pivot);
    // Written so that a pivot that is no number fails too.
    if (!(size > panel.smallest[j0 + j]) || !(size <= __DBL_MAX__)) return j0 + j;
    const double sign = pivot < 0.0 ? -1.0 : 1.0;
    panel.signs[j0 + j] = sign;
    const double root = __builtin_sqrt(size);
    column[j] = root;
    inverse[j] = sign / root;
    for (int i = j + 1; i < n; ++i) {
      double entry = column[i];
      for (int p = 0; p < j; ++p) entry -= scaled[i][p] * panel.values[(j0 + p) * panel.stride + j0 + j];
      column[i] = entry * inverse[j];
      scaled[i][j] = column[i] * sign;
    }
  }
  return -1;
}

/// Rows row..row+vectors*lanes-1 below a full corner of eight columns.
template <int vectors>
inline void solve_rows(const Panel& panel, int j0, int row, const double (&scaled)[8][8], const double (&inverse)[8]) {
  VectorD x[8][vectors];
  double* first = panel.values + j0 * panel.stride + row;
  for (int j = 0; j < 8; ++j) {
    for (int v = 0; v < vectors; ++v) x[j][v] = load(first + j * panel.stride + v * lanes);
    for (int p = 0; p < j; ++p) {
      const VectorD factor = splat(scaled[j][p]);
      for (int v = 0; v < vectors; ++v) x[j][v] -= x[p][v] * factor;
    }
    const VectorD factor = splat(inverse[j]);
    for (int v = 0; v < vectors; ++v) {
      x[j][v] *= factor;
      store(first + j * panel.stride + v * lanes, x[j][v]);
    }
  }
}

inline int factor_eight(const Panel& panel, int j0, int n) {
  double scaled[8][8];
  double inverse[8];
  const int failed = factor_corner(panel, j0, n, scaled, inverse);
  if (failed >= 0) return failed;
  const int end = rounded_up(panel.m);
  int row = j0 + n;
  if (n == 8) {
    constexpr int vectors = lanes == 8 ? 2 : 1;
    for (; row + vectors * lanes <= end; row += vectors * lanes) solve_rows<vectors>(panel, j0, row, scaled, inverse);
    for (; row < end; row += lanes) solve_rows<1>(panel, j0, row, scaled, inverse);
    return -1;
  }
  for (int j = 0; j < n; ++j) {  // the last columns of a panel, few
    double* column = panel.values + (j0 + j) * panel.stride;
    for (int p = 0; p < j; ++p) {
      const double* other = panel.values + (j0 + p) * panel.stride;
      for (int i = row; i < end; ++i) column[i] -= other[i] * scaled[j][p];
    }
    for (int i = row; i < end; ++i) column[i] *= inverse[j];
  }
  return -1;
}

/// Halves the columns until eight are left: most of the work is then in deep updates.
inline int factor_columns(const Panel& panel, int j0, int j1) {
  if (j1 - j0 <= 8) return factor_eight(panel, j0, j1 - j0);
  const int middle = j0 + rounded_up((j1 - j0 + 1) / 2);
  const int failed = factor_columns(panel, j0, middle);
  if (failed >= 0) return failed;
  const Update u{j0, middle, middle, j1, panel.values + middle * panel.stride + middle, panel.stride};
  ChunkedUpdate<false>{panel, u}.run();
  return factor_columns(panel, middle, j1);
}

inline int factor_panel(const Panel& panel) { return panel.k == 0 ? -1 : factor_columns(panel, 0, panel.k); }

inline void schur_update(const Panel& panel, double* update, std::ptrdiff_t update_stride) {
  const Update u{0, panel.k, panel.k, panel.m, update, update_stride};
  ChunkedUpdate<true>{panel, u}.run();
}

}  // namespace
}  // namespace muldi::math::kernels
