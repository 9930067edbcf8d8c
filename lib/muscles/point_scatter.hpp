#pragma once
/// Adds 6 x 6 second derivatives by two points into the block matrix, through the points' constant maps.
#include <array>
#include <cstddef>
#include <vector>

#include "math/block_matrix.hpp"
#include "model/interval_term.hpp"
#include "model/linear_point.hpp"
#include "muscles/two_point.hpp"

namespace muldi::muscles {

class PointScatter {
 public:
  static constexpr int longest_run = 4;  ///< entries side by side that are written at once: a body point

  PointScatter(const model::LinearPoint& a1, const model::LinearPoint& a2);

  void request(model::PatternRequest& pattern) const;
  void bind(const math::BlockPattern& pattern);

  /// K += A^T H A with the 6 x n_q matrix A of both points; H (6, 6) need not be symmetric.
  void add(const Matrix6& H, math::BlockMatrix& K) const;

 private:
  // Entries of one point that stand side by side in one node: a strip of a stored block.
  struct Run {
    int point = 0;  // 0 or 1
    int node = 0;
    int first_dof = 0;
    int n = 0;
    std::array<double, static_cast<std::size_t>(longest_run)> weight{};
  };

  void add_runs(const model::LinearPoint& point, int index);

  std::vector<Run> runs_;
  std::vector<math::BlockSlot> slots_;  // runs x runs, at the first entry of the strip
};

}  // namespace muldi::muscles
