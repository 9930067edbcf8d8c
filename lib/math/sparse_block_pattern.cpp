#include "math/sparse_block_pattern.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace muldi::math {
namespace {

/// Upper neighbours of every node, repeats included: first counted, then filled.
struct Buckets {
  std::vector<std::ptrdiff_t> start;
  std::vector<int> columns;
};

template <class Visit>
void for_each_pair(int n_nodes, std::span<const std::array<int, 8>> cells, std::span<const std::pair<int, int>> pairs,
                   Visit&& visit) {
  for (int i = 0; i < n_nodes; ++i) visit(i, i);
  for (const std::array<int, 8>& cell : cells) {
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = a + 1; b < 8; ++b) visit(std::min(cell[a], cell[b]), std::max(cell[a], cell[b]));
    }
  }
  for (const auto& [i, j] : pairs) visit(std::min(i, j), std::max(i, j));
}

Buckets upper_neighbours(int n_nodes, std::span<const std::array<int, 8>> cells,
                         std::span<const std::pair<int, int>> pairs) {
  Buckets buckets;
  buckets.start.assign(static_cast<std::size_t>(n_nodes) + 1, 0);
  for_each_pair(n_nodes, cells, pairs, [&](int i, int j) {
    MULDI_EXPECT(i >= 0 && j < n_nodes, "nodes of cells and pairs lie in the mesh");
    ++buckets.start[static_cast<std::size_t>(i) + 1];
  });
  for (std::size_t i = 1; i < buckets.start.size(); ++i) buckets.start[i] += buckets.start[i - 1];
  buckets.columns.resize(static_cast<std::size_t>(buckets.start.back()));
  std::vector<std::ptrdiff_t> next(buckets.start.begin(), buckets.start.end() - 1);
  for_each_pair(n_nodes, cells, pairs, [&](int i, int j) {
    buckets.columns[static_cast<std::size_t>(next[static_cast<std::size_t>(i)]++)] = j;
  });
  return buckets;
}

}  // namespace

SymmetricBlockPattern::SymmetricBlockPattern(int n_nodes, int block_size, std::span<const std::array<int, 8>> cells,
                                             std::span<const std::pair<int, int>> pairs)
    : n_nodes_(n_nodes), block_size_(block_size) {
  MULDI_EXPECT(n_nodes >= 0 && block_size >= 1 && block_size <= 4, "one to four unknowns a node");
  Buckets buckets = upper_neighbours(n_nodes, cells, pairs);
  row_start_.reserve(static_cast<std::size_t>(n_nodes) + 1);
  row_start_.push_back(0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(n_nodes); ++i) {
    const auto first = buckets.columns.begin() + buckets.start[i];
    const auto last = buckets.columns.begin() + buckets.start[i + 1];
    std::sort(first, last);
    columns_.insert(columns_.end(), first, std::unique(first, last));
    row_start_.push_back(static_cast<int>(columns_.size()));
  }
  columns_.shrink_to_fit();
  cell_slots_.reserve(cells.size());
  for (const std::array<int, 8>& cell : cells) {
    CellSlots slots{};
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = a; b < 8; ++b) {
        MULDI_EXPECT(a == b || cell[a] != cell[b], "the nodes of a cell differ");
        const int stored = slot(std::min(cell[a], cell[b]), std::max(cell[a], cell[b]));
        slots[static_cast<std::size_t>(cell_pair(static_cast<int>(a), static_cast<int>(b)))] =
            2u * static_cast<std::uint32_t>(stored) + (cell[a] > cell[b] ? 1u : 0u);
      }
    }
    cell_slots_.push_back(slots);
  }
}

int SymmetricBlockPattern::slot(int i, int j) const {
  MULDI_EXPECT(0 <= i && i <= j && j < n_nodes_, "a stored block has row node <= column node");
  const auto first = columns_.begin() + row_start_[static_cast<std::size_t>(i)];
  const auto last = columns_.begin() + row_start_[static_cast<std::size_t>(i) + 1];
  const auto found = std::lower_bound(first, last, j);
  return found != last && *found == j ? static_cast<int>(found - columns_.begin()) : -1;
}

}  // namespace muldi::math
