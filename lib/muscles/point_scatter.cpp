#include "muscles/point_scatter.hpp"

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace muldi::muscles {
namespace {

/// target(3 i + r, 3 j + c) += row_i column_j H(r, c), j < n.
template <int n>
void add_block(std::span<const double> rows, const double* columns, const Eigen::Matrix3d& H, double* target,
               std::ptrdiff_t stride) {
  using Strip = Eigen::Array<double, 3 * n, 1>;
  for (Eigen::Index r = 0; r < 3; ++r) {
    Strip strip;
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index c = 0; c < 3; ++c) strip[3 * j + c] = columns[j] * H(r, c);
    }
    double* to = target + r * stride;
    for (const double w : rows) {
      Eigen::Map<Strip>(to, 3 * n) += w * strip;
      to += 3 * stride;
    }
  }
}

}  // namespace

PointScatter::PointScatter(const model::LinearPoint& a1, const model::LinearPoint& a2) {
  add_runs(a1, 0);
  add_runs(a2, 1);
}

void PointScatter::add_runs(const model::LinearPoint& point, int index) {
  for (int k = 0; k < point.n; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const bool continues = !runs_.empty() && runs_.back().point == index && runs_.back().n < longest_run &&
                           runs_.back().node == point.node[at] &&
                           runs_.back().first_dof + 3 * runs_.back().n == point.dof[at];
    if (!continues) runs_.push_back({.point = index, .node = point.node[at], .first_dof = point.dof[at]});
    Run& run = runs_.back();
    run.weight[static_cast<std::size_t>(run.n++)] = point.weight[at];
  }
}

void PointScatter::request(model::PatternRequest& pattern) const {
  for (const Run& row : runs_) {
    for (const Run& column : runs_) pattern.add_pair(row.node, column.node);
  }
}

void PointScatter::bind(const math::BlockPattern& pattern) {
  slots_.clear();
  for (const Run& row : runs_) {
    for (const Run& column : runs_) {
      math::BlockSlot slot = pattern.slot(row.node, column.node);
      slot.first += (row.first_dof - pattern.offset(row.node)) * slot.stride;
      slot.first += column.first_dof - pattern.offset(column.node);
      slots_.push_back(slot);
    }
  }
}

void PointScatter::add(const Matrix6& H, math::BlockMatrix& K) const {
  auto slot = slots_.begin();
  for (const Run& row : runs_) {
    const std::span<const double> rows(row.weight.data(), static_cast<std::size_t>(row.n));
    for (const Run& column : runs_) {
      const Eigen::Matrix3d block = H.block<3, 3>(3 * row.point, 3 * column.point);
      double* target = K.data(*slot);
      // With the width known, the compiler unrolls the strip.
      switch (column.n) {
        case 1:
          add_block<1>(rows, column.weight.data(), block, target, slot->stride);
          break;
        case 2:
          add_block<2>(rows, column.weight.data(), block, target, slot->stride);
          break;
        case 3:
          add_block<3>(rows, column.weight.data(), block, target, slot->stride);
          break;
        default:
          add_block<4>(rows, column.weight.data(), block, target, slot->stride);
      }
      ++slot;
    }
  }
}

}  // namespace muldi::muscles
