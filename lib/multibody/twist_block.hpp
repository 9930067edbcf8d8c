#pragma once
/// Blocks of the tangent in twists: T_int(left)^T K T_int(right), 12 x 12 to 6 x 6 (numerics, 1.6).
#include <Eigen/Geometry>

#include "math/block_matrix.hpp"
#include "multibody/null_space.hpp"

namespace muldi::multibody {

inline Matrix6 twist_block(const math::BlockMatrix& K, const math::BlockSlot& slot, const Eigen::Matrix3d& left,
                           const Eigen::Matrix3d& right) {
  using Rows12 = Eigen::Matrix<double, 12, 12, Eigen::RowMajor>;
  const Eigen::Map<const Rows12, 0, Eigen::OuterStride<>> block(K.data(slot), Eigen::OuterStride<>(slot.stride));
  Eigen::Matrix<double, 12, 6> half;
  half.leftCols<3>() = block.leftCols<3>();
  for (int row = 0; row < 12; ++row) {
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      moment += right.col(k).cross(Eigen::Vector3d(block.block<1, 3>(row, 3 + 3 * k).transpose()));
    }
    half.block<1, 3>(row, 3) = moment.transpose();
  }
  Matrix6 result;
  result.topRows<3>() = half.topRows<3>();
  for (int column = 0; column < 6; ++column) {
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) moment += left.col(k).cross(Eigen::Vector3d(half.block<3, 1>(3 + 3 * k, column)));
    result.block<3, 1>(3, column) = moment;
  }
  return result;
}

}  // namespace muldi::multibody
