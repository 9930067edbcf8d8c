#pragma once
/// Vectors of space that are constant linear maps of the configuration: attachments and directions.
///
/// A body point is phi + sum xi_k d_k, a body-fixed direction sum c_k d_k, a mesh point sum N_a x_a, ground a constant
/// (architecture, section 3). Joints, muscles, springs, loads and ties are all written against this one map
///
///     a(q) = offset + sum_k weight_k q[dof_k .. dof_k + 3).
#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "base/error.hpp"

namespace muldi::model {

/// a(q) in R^3 as above.
struct LinearPoint {
  static constexpr int capacity = 12;  ///< two bodies (8), or a mesh point of eight nodes and a body

  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  int n = 0;
  std::array<int, capacity> dof{};   ///< first of three consecutive entries of q
  std::array<int, capacity> node{};  ///< node (slice) of the block pattern that owns the entries
  std::array<double, capacity> weight{};

  /// A point or vector that does not move.
  static LinearPoint constant(const Eigen::Vector3d& value) {
    LinearPoint point;
    point.offset = value;
    return point;
  }

  void add(int owner, int first_dof, double w) {
    if (w == 0.0) return;
    MULDI_EXPECT(n < capacity, "a linear point of more than `capacity` entries");
    const auto at = static_cast<std::size_t>(n++);
    node[at] = owner;
    dof[at] = first_dof;
    weight[at] = w;
  }

  bool is_constant() const { return n == 0; }

  /// a(q).
  Eigen::Vector3d value(const Eigen::VectorXd& q) const { return offset + rate(q); }

  /// The linear part applied to a velocity or a variation.
  Eigen::Vector3d rate(const Eigen::VectorXd& v) const {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    for (int k = 0; k < n; ++k) {
      const auto at = static_cast<std::size_t>(k);
      result += weight[at] * v.segment<3>(dof[at]);
    }
    return result;
  }

  /// f += A^T force, the transpose of `rate`.
  void add_transposed(const Eigen::Vector3d& force, Eigen::VectorXd& f) const {
    for (int k = 0; k < n; ++k) {
      const auto at = static_cast<std::size_t>(k);
      f.segment<3>(dof[at]) += weight[at] * force;
    }
  }

  /// a - b as one map; entries of both are kept.
  friend LinearPoint operator-(const LinearPoint& a, const LinearPoint& b) {
    LinearPoint result = a;
    result.offset -= b.offset;
    for (int k = 0; k < b.n; ++k) {
      const auto at = static_cast<std::size_t>(k);
      result.add(b.node[at], b.dof[at], -b.weight[at]);
    }
    return result;
  }
};

}  // namespace muldi::model
