#pragma once
/// The symbolic part of the multifrontal L S L^T factorisation: done once for a pattern.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "math/sparse_block_matrix.hpp"
#include "math/sparse_block_pattern.hpp"
#include "math/sparse_ordering.hpp"

namespace muldi::math {

/// What a factorisation will take; known before any value.
struct LdltSize {
  std::ptrdiff_t n_unknowns = 0;      ///< those that are not constrained
  std::ptrdiff_t factor_entries = 0;  ///< stored values of L, padding included
  std::ptrdiff_t factor_bytes = 0;    ///< in double precision; half of it with single-precision storage
  std::ptrdiff_t work_bytes = 0;      ///< updates under way, and the buffers of one thread
  double flops = 0.0;                 ///< additions and multiplications of one factorisation
  int n_fronts = 0;
  int largest_front = 0;  ///< rows
  Ordering ordering = Ordering::natural;
};

/// Order of elimination, fronts and the places of everything in them. Constrained unknowns take no part.
class LdltAnalysis {
 public:
  /// `mask`: constrained unknowns, none if it is empty; a changed mask wants a new analysis. The pattern need not live
  /// on.
  explicit LdltAnalysis(const SymmetricBlockPattern& pattern, NodeMask mask = {},
                        Ordering ordering = Ordering::automatic);

  const LdltSize& size() const { return size_; }
  const NodeMask& mask() const { return mask_; }

  /// A stretch of rows of a front: where it begins in the order of elimination, or in another front.
  struct Run {
    int from = 0;
    int to = 0;
    int length = 0;
  };
  /// A block of the matrix, and its place in a front (rows and columns of its free unknowns).
  struct Entry {
    int slot = 0;
    int row = 0;
    int column = 0;
    std::uint8_t row_mask = 0;     // constrained unknowns of the node of `row`
    std::uint8_t column_mask = 0;  // and of the node of `column`
    bool transposed = false;       // the stored block has the rows of the node of `column`
  };
  struct Front {
    int first = 0;     // first pivot in the order of elimination
    int n_pivots = 0;  // k
    int n_rows = 0;    // m
    int stride = 0;    // distance of two columns of the panel
    int parent = -1;
    int stack = 0;                    // which of the two stacks takes the update
    std::ptrdiff_t factor_start = 0;  // of the panel in the factor
    std::ptrdiff_t update_start = 0;  // of the update in its stack
    int update_stride = 0;
    std::array<int, 2> entries{};   // range in entries()
    std::array<int, 2> children{};  // range in children()
    std::array<int, 2> rows{};      // range in row_runs(): rows below the pivots; from: unknown, to: row
    std::array<int, 2> map{};       // range in map_runs(): the same rows; from: row, to: row in the parent
  };
  const std::vector<Front>& fronts() const { return fronts_; }
  const std::vector<Entry>& entries() const { return entries_; }
  const std::vector<int>& children() const { return children_; }
  const std::vector<Run>& row_runs() const { return row_runs_; }
  const std::vector<Run>& map_runs() const { return map_runs_; }
  /// For each free unknown in the order of elimination, its number in the matrix.
  const std::vector<int>& unknowns() const { return unknowns_; }
  /// The constrained unknowns.
  const std::vector<int>& constrained() const { return constrained_; }
  /// Values of the two stacks of updates.
  const std::array<std::ptrdiff_t, 2>& stack_sizes() const { return stack_sizes_; }
  int largest_stride() const { return largest_stride_; }
  int block_size() const { return block_size_; }
  int n_blocks() const { return n_blocks_; }
  std::ptrdiff_t n_rows() const { return n_rows_; }
  /// Values of the largest panel.
  std::ptrdiff_t largest_panel() const { return largest_panel_; }

 private:
  struct Builder;

  NodeMask mask_;
  int block_size_;
  int n_blocks_;
  std::ptrdiff_t n_rows_;
  LdltSize size_;
  std::vector<Front> fronts_;
  std::vector<Entry> entries_;
  std::vector<int> children_;
  std::vector<Run> row_runs_;
  std::vector<Run> map_runs_;
  std::vector<int> unknowns_;
  std::vector<int> constrained_;
  std::array<std::ptrdiff_t, 2> stack_sizes_{};
  int largest_stride_ = 0;
  std::ptrdiff_t largest_panel_ = 0;
};

}  // namespace muldi::math
