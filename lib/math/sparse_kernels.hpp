#pragma once
/// The inner loops of the sparse solvers, compiled for several instruction sets and chosen when the program starts.
///
/// The sets differ in the last bits of a result (fused products); on one machine results never vary.
#include <cstddef>
#include <type_traits>

namespace muldi::math::kernels {

/// Rows first_row..last_row-1 of a symmetric block matrix times x, added to the strip, whose first value belongs to
/// first_row and which reaches to the last column of these rows.
template <class Scalar>
struct BlockRows {
  const int* row_start;
  const int* columns;
  const Scalar* values;  ///< readable for 4 values past the end
  const Scalar* x;
  Scalar* strip;
  int first_row;
  int last_row;
};

/// Row padding of a panel: rows come in multiples of this, the last ones zero.
inline constexpr int row_multiple = 8;
/// Depth of the packed products.
inline constexpr int pack_depth = 256;
/// Rows of one packed block; a multiple of every tile.
inline constexpr int pack_rows = 192;
/// Columns of an update that one thread takes at a time.
inline constexpr int chunk_columns = 128;
/// Values of the packing buffers of one thread.
inline constexpr std::ptrdiff_t pack_size =
    static_cast<std::ptrdiff_t>(pack_depth) * (pack_rows + chunk_columns + row_multiple);

/// The pivot columns of a front, column-major: m x k, m >= k, entries above the diagonal are never used.
struct Panel {
  double* values;
  std::ptrdiff_t stride;  ///< distance of two columns, a multiple of row_multiple, >= m; rows m..stride-1 are zero
  int m;
  int k;
  double* signs;           ///< (k) signs of the pivots, written
  const double* smallest;  ///< (k) magnitude at or below which a pivot counts as zero
  double* pack;            ///< pack_size values for each thread
  /// The loop over chunks and the number of a thread: base::run_chunks and base::thread_number.
  void (*run_chunks)(int n_chunks, void (*chunk)(void*, int), void* context);
  int (*thread_number)();
};

/// Solves with a finished panel; w (stride x n_columns) holds the pivot rows first, columns `w_stride` apart.
template <class Scalar>
struct PanelSolve {
  const Scalar* values;
  std::ptrdiff_t stride;
  int m;
  int k;
  const double* signs;
  Scalar* w;
  std::ptrdiff_t w_stride;
  int n_columns;
};

/// The loops for one instruction set.
struct Table {
  const char* name;
  void (*block_product_double[5])(const BlockRows<double>&);
  void (*block_product_float[5])(const BlockRows<float>&);
  /// L S L^T of the pivot rows and L of the rows below, in place; the first zero pivot, or -1.
  int (*factor_panel)(const Panel&);
  /// U = -L2 S L2^T (lower part; the rest is overwritten with anything), L2 the rows k..m-1. Column c of U starts at
  /// update + c * update_stride; its row r lies at r + k % row_multiple there (both counted from k).
  void (*schur_update)(const Panel&, double* update, std::ptrdiff_t update_stride);
  void (*forward_double)(const PanelSolve<double>&);
  void (*backward_double)(const PanelSolve<double>&);
  void (*forward_float)(const PanelSolve<float>&);
  void (*backward_float)(const PanelSolve<float>&);

  template <class Scalar>
  auto block_product(int block_size) const {
    if constexpr (std::is_same_v<Scalar, double>) {
      return block_product_double[block_size];
    } else {
      return block_product_float[block_size];
    }
  }

  template <class Scalar>
  auto forward() const {
    if constexpr (std::is_same_v<Scalar, double>) {
      return forward_double;
    } else {
      return forward_float;
    }
  }
  template <class Scalar>
  auto backward() const {
    if constexpr (std::is_same_v<Scalar, double>) {
      return backward_double;
    } else {
      return backward_float;
    }
  }
};

/// The loops for this processor.
const Table& table();
/// The loops for an instruction set: 1, 3 or 4 for x86-64-v1, v3, v4; null if this processor or build has none.
const Table* table_of_level(int level);
/// Makes table() return those of the highest available level <= `level`; for tests and for runs that must agree to the
/// last bit between machines. Not while a solver works.
void limit_level(int level);

}  // namespace muldi::math::kernels
