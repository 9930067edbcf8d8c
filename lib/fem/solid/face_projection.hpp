#pragma once
/// Where a point lies on a face.
#include <Eigen/Core>
#include <array>

namespace muldi::fem {

/// The nearest point of a bilinear face: its shape functions there, and how far it is.
struct FaceProjection {
  std::array<double, 4> weights = {};  ///< of the corners; their sum is 1
  double distance = 0.0;
};

/// `corners` (3 x 4): positions of the corners, going round.
FaceProjection project_on_face(const Eigen::Vector3d& point, const Eigen::Matrix<double, 3, 4>& corners);

}  // namespace muldi::fem
