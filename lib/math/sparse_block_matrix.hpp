#pragma once
/// Symmetric sparse matrices of b x b blocks: values over a SymmetricBlockPattern, products, constrained unknowns.
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "math/sparse_block_pattern.hpp"

namespace muldi::math {

/// One byte a node; bit i says that unknown i of the node is constrained: its row and column are those of the identity.
using NodeMask = std::vector<std::uint8_t>;

/// Values over a pattern, which must outlive the matrix. The entry (i, j) of the block at `slot` is
/// values()[slot * b * b + b * i + j]; diagonal blocks are stored whole and must be symmetric.
template <class Scalar>
class BasicBlockMatrix {
 public:
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  /// All values zero. `block_size`: unknowns a node; that of the pattern if it is not given.
  explicit BasicBlockMatrix(const SymmetricBlockPattern& pattern, std::optional<int> block_size = {});

  const SymmetricBlockPattern& pattern() const { return *pattern_; }
  int block_size() const { return block_size_; }
  std::ptrdiff_t n_rows() const { return static_cast<std::ptrdiff_t>(pattern_->n_nodes()) * block_size_; }
  std::span<Scalar> values() { return {values_.data(), n_values_}; }
  std::span<const Scalar> values() const { return {values_.data(), n_values_}; }
  void set_zero();

  /// y = A x; x, y (n_rows), not the same vector. The same bits for any number of threads; requests no memory. One
  /// product of a matrix at a time.
  void multiply(const Eigen::Ref<const Vector>& x, Eigen::Ref<Vector> y) const;
  /// The diagonal entries (n_rows).
  void diagonal(Eigen::Ref<Vector> out) const;
  /// Clears the rows and columns of the constrained unknowns; their diagonal becomes `diagonal_value`, or keeps its own
  /// value (1 where it is zero), which keeps the size and the sign of a potential's diagonal.
  void constrain(const NodeMask& mask, std::optional<double> diagonal_value = {});
  /// Takes the leading block_size() x block_size() part of every block of a double matrix over the same pattern.
  void assign_leading(const BasicBlockMatrix<double>& from);
  /// The matrix as a dense one, for tests and small systems.
  Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> dense() const;

 private:
  /// The product runs over fixed ranges of rows; each sums into a strip of its own that reaches to its last column.
  struct Chunk {
    int first_row = 0;
    int last_row = 0;     // one past the end
    int last_column = 0;  // one past the end, >= last_row
    std::ptrdiff_t strip = 0;
  };
  void add_strips(std::size_t chunk, Scalar* y) const;

  const SymmetricBlockPattern* pattern_;
  int block_size_;
  std::size_t n_values_;
  std::vector<Scalar> values_;  // some more than n_values_: vector loads run over the end of the last block
  std::vector<Chunk> chunks_;
  mutable std::vector<Scalar> strips_;
};

using SymmetricBlockMatrix = BasicBlockMatrix<double>;
/// The same in single precision, for preconditioners: half the memory traffic.
using FloatBlockMatrix = BasicBlockMatrix<float>;

extern template class BasicBlockMatrix<double>;
extern template class BasicBlockMatrix<float>;

}  // namespace muldi::math
