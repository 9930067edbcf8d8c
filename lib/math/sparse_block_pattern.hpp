#pragma once
/// The pattern of a symmetric sparse matrix of b x b blocks over the nodes of a mesh; only blocks with row node <=
/// column node are stored.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace muldi::math {

/// Where the 36 blocks of a cell go, for the local pairs (a, b), a <= b, in the order (0,0) (0,1) ... (0,7) (1,1) ...
/// Each number is 2 * slot + t; t = 1 says that the stored block is the transpose of the block (a, b).
using CellSlots = std::array<std::uint32_t, 36>;

/// The position of the pair (a, b), a <= b < 8, in CellSlots.
constexpr int cell_pair(int a, int b) { return a * 8 - a * (a - 1) / 2 + b - a; }

/// Which blocks a symmetric matrix stores, by rows; immutable once built.
class SymmetricBlockPattern {
 public:
  /// `n_nodes`; `block_size` b: 1 to 4 unknowns a node; `cells`: eight distinct nodes each; `pairs`: further coupled
  /// nodes in any order, repeats allowed. The diagonal is always stored. ContractError for nodes out of range.
  SymmetricBlockPattern(int n_nodes, int block_size, std::span<const std::array<int, 8>> cells,
                        std::span<const std::pair<int, int>> pairs = {});

  int n_nodes() const { return n_nodes_; }
  int block_size() const { return block_size_; }
  std::ptrdiff_t n_rows() const { return static_cast<std::ptrdiff_t>(n_nodes_) * block_size_; }
  int n_blocks() const { return static_cast<int>(columns_.size()); }
  /// First slot of each row node, and the number of slots at the end (n_nodes + 1).
  std::span<const int> row_start() const { return row_start_; }
  /// Column node of each slot, ascending in a row; the first of a row is its diagonal.
  std::span<const int> columns() const { return columns_; }
  /// The slot of the block (i, j), i <= j; -1 if it is not stored.
  int slot(int i, int j) const;
  /// The slots of every cell that was given, in that order.
  std::span<const CellSlots> cell_slots() const { return cell_slots_; }

 private:
  int n_nodes_;
  int block_size_;
  std::vector<int> row_start_;
  std::vector<int> columns_;
  std::vector<CellSlots> cell_slots_;
};

}  // namespace muldi::math
