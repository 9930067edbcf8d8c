#include "math/csr_matrix.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace muldi::math {

using Index = std::size_t;

DoubleCsr component_matrix(const SymmetricBlockMatrix& matrix, int component, double factor) {
  const SymmetricBlockPattern& pattern = matrix.pattern();
  const int b = matrix.block_size();
  MULDI_EXPECT(component >= 0 && component < b, "a component of the blocks");
  DoubleCsr result;
  result.n_rows = result.n_columns = pattern.n_nodes();
  result.start.assign(static_cast<Index>(pattern.n_nodes()) + 1, 0);
  const auto for_each = [&](auto&& visit) {
    for (int i = 0; i < pattern.n_nodes(); ++i) {
      for (int s = pattern.row_start()[static_cast<Index>(i)]; s < pattern.row_start()[static_cast<Index>(i) + 1];
           ++s) {
        const int j = pattern.columns()[static_cast<Index>(s)];
        const double value =
            factor *
            matrix.values()[static_cast<Index>((static_cast<std::ptrdiff_t>(s) * b + component) * b + component)];
        if (value == 0.0 && i != j) continue;
        visit(i, j, value);
        if (i != j) visit(j, i, value);
      }
    }
  };
  for_each([&](int i, int, double) { ++result.start[static_cast<Index>(i) + 1]; });
  for (Index i = 1; i < result.start.size(); ++i) result.start[i] += result.start[i - 1];
  result.columns.resize(static_cast<Index>(result.start.back()));
  result.values.resize(result.columns.size());
  std::vector<int> next(result.start.begin(), result.start.end() - 1);
  for_each([&](int i, int j, double value) {
    const Index place = static_cast<Index>(next[static_cast<Index>(i)]++);
    result.columns[place] = j;
    result.values[place] = value;
  });
  return result;
}

DoubleCsr transposed(const DoubleCsr& a) {
  DoubleCsr result;
  result.n_rows = a.n_columns;
  result.n_columns = a.n_rows;
  result.start.assign(static_cast<Index>(a.n_columns) + 1, 0);
  for (const int column : a.columns) ++result.start[static_cast<Index>(column) + 1];
  for (Index i = 1; i < result.start.size(); ++i) result.start[i] += result.start[i - 1];
  result.columns.resize(a.columns.size());
  result.values.resize(a.values.size());
  std::vector<int> next(result.start.begin(), result.start.end() - 1);
  for (int i = 0; i < a.n_rows; ++i) {
    a.for_row(i, [&](int column, double value) {
      const Index place = static_cast<Index>(next[static_cast<Index>(column)]++);
      result.columns[place] = i;
      result.values[place] = value;
    });
  }
  return result;
}

DoubleCsr product(const DoubleCsr& a, const DoubleCsr& b) {
  MULDI_EXPECT(a.n_columns == b.n_rows, "sizes that fit");
  DoubleCsr result;
  result.n_rows = a.n_rows;
  result.n_columns = b.n_columns;
  std::vector<int> place(static_cast<Index>(b.n_columns), -1);  // of a column in the result, if in the present row
  for (int i = 0; i < a.n_rows; ++i) {
    const int first = result.start.back();
    a.for_row(i, [&](int k, double left) {
      b.for_row(k, [&](int j, double right) {
        int& at = place[static_cast<Index>(j)];
        if (at < first) {
          at = static_cast<int>(result.columns.size());
          result.columns.push_back(j);
          result.values.push_back(0.0);
        }
        result.values[static_cast<Index>(at)] += left * right;
      });
    });
    result.start.push_back(static_cast<int>(result.columns.size()));
  }
  return result;
}

FloatCsr in_single_precision(const DoubleCsr& a) {
  return {a.n_rows, a.n_columns, a.start, a.columns, std::vector<float>(a.values.begin(), a.values.end())};
}

}  // namespace muldi::math
