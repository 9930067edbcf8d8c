#pragma once
/// Writes the entries of a sparse matrix in the order in which code visits them, which is the same in every pass: the
/// first pass finds the pattern, so that it cannot differ from what is written.
#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "control/nlp.hpp"

namespace muldi::control {

class SparseEntries {
 public:
  /// Only entries on and below the diagonal are stored; others are mirrored.
  explicit SparseEntries(bool lower_triangle) : lower_triangle_(lower_triangle) {}

  /// Adds to the entry; rows and columns that do not exist (-1) are left out.
  void add(int row, int column, double value) {
    if (row < 0 || column < 0) return;
    if (values_ == nullptr) {
      record(row, column);
      return;
    }
    values_[slots_[at_++]] += value;
  }

  /// The passes after the first write to `values` (pattern().size()), set to 0.
  void begin(double* values) {
    values_ = values;
    at_ = 0;
    std::fill(values, values + pattern_.size(), 0.0);
  }
  /// False in the first pass.
  bool writing() const { return values_ != nullptr; }
  const SparsePattern& pattern() const { return pattern_; }

 private:
  void record(int row, int column) {
    if (lower_triangle_ && row < column) std::swap(row, column);
    const auto [place, is_new] = known_.try_emplace({row, column}, static_cast<int>(pattern_.size()));
    if (is_new) {
      pattern_.rows.push_back(row);
      pattern_.columns.push_back(column);
    }
    slots_.push_back(place->second);
  }

  bool lower_triangle_;
  SparsePattern pattern_;
  std::map<std::pair<int, int>, int> known_;
  std::vector<int> slots_;
  std::size_t at_ = 0;
  double* values_ = nullptr;
};

}  // namespace muldi::control
