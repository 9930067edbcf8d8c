#pragma once
/// Sparse matrices of dense blocks over a partition of the unknowns, with a pattern that is fixed before the first
/// value.
///
/// Unknowns are grouped into nodes (12 for a director body, 1 for a free length, 3 for a mesh node). The stored blocks
/// of a node's rows stand side by side in one dense row-major strip, so a block is a strided view and scattering into
/// it needs no search: the slot is found once, when the pattern is bound.
#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

namespace muldi::math {

/// Where a block lies in the values of a BlockMatrix.
struct BlockSlot {
  std::ptrdiff_t first = -1;  ///< index of the block's (0,0) entry
  std::ptrdiff_t stride = 0;  ///< distance of two rows
};

/// The nodes and the set of stored blocks; immutable once built.
class BlockPattern {
 public:
  /// `sizes` (n): unknowns a node; `pairs`: stored blocks (row node, column node) in any order, repeats allowed.
  /// The pattern is made structurally symmetric and always holds the diagonal.
  BlockPattern(std::vector<int> sizes, const std::vector<std::pair<int, int>>& pairs);

  int n_nodes() const { return static_cast<int>(sizes_.size()); }
  int size(int node) const { return sizes_[static_cast<std::size_t>(node)]; }
  int offset(int node) const { return offsets_[static_cast<std::size_t>(node)]; }
  int n_rows() const { return offsets_.back(); }
  std::ptrdiff_t n_values() const { return n_values_; }
  /// Column nodes of the stored blocks in the rows of `node`, ascending.
  const std::vector<int>& columns(int node) const { return columns_[static_cast<std::size_t>(node)]; }
  bool contains(int row, int column) const;
  /// The place of a stored block; ContractError if it is not stored.
  BlockSlot slot(int row, int column) const;
  /// The place of the k-th stored block of a row node, columns(row)[k].
  BlockSlot stored_slot(int row, std::size_t k) const;

 private:
  std::vector<int> sizes_;
  std::vector<int> offsets_;  // n + 1
  std::vector<std::vector<int>> columns_;
  std::vector<std::vector<int>> column_at_;  // where each stored block begins within its strip
  std::vector<std::ptrdiff_t> strip_;        // first value of a node's strip
  std::vector<int> width_;                   // row length of a node's strip
  std::ptrdiff_t n_values_ = 0;
};

/// Values over a BlockPattern, which must outlive the matrix.
class BlockMatrix {
 public:
  using Block =
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0, Eigen::OuterStride<>>;
  using ConstBlock =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0, Eigen::OuterStride<>>;

  explicit BlockMatrix(const BlockPattern& pattern)
      : pattern_(&pattern), values_(Eigen::VectorXd::Zero(pattern.n_values())) {}

  const BlockPattern& pattern() const { return *pattern_; }
  void set_zero() { values_.setZero(); }
  double* data(const BlockSlot& slot) { return values_.data() + slot.first; }
  const double* data(const BlockSlot& slot) const { return values_.data() + slot.first; }
  Block block(int row, int column);
  ConstBlock block(int row, int column) const;
  /// y = A x; x, y (n_rows).
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  /// The matrix as a dense one, for tests and small systems.
  Eigen::MatrixXd dense() const;

 private:
  const BlockPattern* pattern_;
  Eigen::VectorXd values_;
};

}  // namespace muldi::math
