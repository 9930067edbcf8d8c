#pragma once
/// Scalar sparse matrices by rows: what the multigrid is made of.
#include <cstddef>
#include <span>
#include <vector>

#include "math/sparse_block_matrix.hpp"
#include "math/vector_loops.hpp"

namespace muldi::math {

/// Rows of entries (column, value), columns in any order.
template <class Scalar>
struct CsrMatrix {
  int n_rows = 0;
  int n_columns = 0;
  std::vector<int> start{0};
  std::vector<int> columns;
  std::vector<Scalar> values;

  /// f(column, value) for the entries of row i.
  template <class F>
  void for_row(std::ptrdiff_t i, F&& f) const {
    for (int e = start[static_cast<std::size_t>(i)]; e < start[static_cast<std::size_t>(i) + 1]; ++e) {
      f(columns[static_cast<std::size_t>(e)], values[static_cast<std::size_t>(e)]);
    }
  }
  /// sum of the products of row i with x.
  Scalar row_times(std::ptrdiff_t i, const Scalar* x) const {
    Scalar sum(0);
    const int end = start[static_cast<std::size_t>(i) + 1];
    for (int e = start[static_cast<std::size_t>(i)]; e < end; ++e) {
      sum += values[static_cast<std::size_t>(e)] * x[columns[static_cast<std::size_t>(e)]];
    }
    return sum;
  }
};

using DoubleCsr = CsrMatrix<double>;
using FloatCsr = CsrMatrix<float>;

/// Both triangles of the part of a block matrix that belongs to one unknown of every node, times `factor`.
DoubleCsr component_matrix(const SymmetricBlockMatrix& matrix, int component, double factor);
DoubleCsr transposed(const DoubleCsr& a);
/// a b
DoubleCsr product(const DoubleCsr& a, const DoubleCsr& b);
FloatCsr in_single_precision(const DoubleCsr& a);

}  // namespace muldi::math
