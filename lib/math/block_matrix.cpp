#include "math/block_matrix.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace muldi::math {

BlockPattern::BlockPattern(std::vector<int> sizes, const std::vector<std::pair<int, int>>& pairs)
    : sizes_(std::move(sizes)) {
  const std::size_t n = sizes_.size();
  offsets_.assign(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) offsets_[i + 1] = offsets_[i] + sizes_[i];
  columns_.resize(n);
  for (std::size_t i = 0; i < n; ++i) columns_[i].push_back(static_cast<int>(i));
  for (const auto& [row, column] : pairs) {
    columns_[static_cast<std::size_t>(row)].push_back(column);
    columns_[static_cast<std::size_t>(column)].push_back(row);
  }
  column_at_.resize(n);
  strip_.resize(n);
  width_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    std::sort(columns_[i].begin(), columns_[i].end());
    columns_[i].erase(std::unique(columns_[i].begin(), columns_[i].end()), columns_[i].end());
    int width = 0;
    for (const int column : columns_[i]) {
      column_at_[i].push_back(width);
      width += size(column);
    }
    strip_[i] = n_values_;
    width_[i] = width;
    n_values_ += static_cast<std::ptrdiff_t>(width) * sizes_[i];
  }
}

bool BlockPattern::contains(int row, int column) const {
  const std::vector<int>& stored = columns(row);
  return std::binary_search(stored.begin(), stored.end(), column);
}

BlockSlot BlockPattern::slot(int row, int column) const {
  MULDI_EXPECT(contains(row, column), "the block is not in the pattern");
  const auto r = static_cast<std::size_t>(row);
  const auto at = std::lower_bound(columns_[r].begin(), columns_[r].end(), column) - columns_[r].begin();
  return stored_slot(row, static_cast<std::size_t>(at));
}

BlockSlot BlockPattern::stored_slot(int row, std::size_t k) const {
  const auto r = static_cast<std::size_t>(row);
  return {.first = strip_[r] + column_at_[r][k], .stride = width_[r]};
}

BlockMatrix::Block BlockMatrix::block(int row, int column) {
  const BlockSlot slot = pattern_->slot(row, column);
  return {data(slot), pattern_->size(row), pattern_->size(column), Eigen::OuterStride<>(slot.stride)};
}

BlockMatrix::ConstBlock BlockMatrix::block(int row, int column) const {
  const BlockSlot slot = pattern_->slot(row, column);
  return {data(slot), pattern_->size(row), pattern_->size(column), Eigen::OuterStride<>(slot.stride)};
}

void BlockMatrix::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  for (int i = 0; i < pattern_->n_nodes(); ++i) {
    auto rows = y.segment(pattern_->offset(i), pattern_->size(i));
    rows.setZero();
    const std::vector<int>& columns = pattern_->columns(i);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const BlockSlot slot = pattern_->stored_slot(i, k);
      const int width = pattern_->size(columns[k]);
      const ConstBlock block(data(slot), pattern_->size(i), width, Eigen::OuterStride<>(slot.stride));
      rows.noalias() += block.lazyProduct(x.segment(pattern_->offset(columns[k]), width));
    }
  }
}

Eigen::MatrixXd BlockMatrix::dense() const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(pattern_->n_rows(), pattern_->n_rows());
  for (int i = 0; i < pattern_->n_nodes(); ++i) {
    for (const int j : pattern_->columns(i)) {
      result.block(pattern_->offset(i), pattern_->offset(j), pattern_->size(i), pattern_->size(j)) = block(i, j);
    }
  }
  return result;
}

}  // namespace muldi::math
