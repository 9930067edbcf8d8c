#pragma once
/// Shares of nodes in the areas of faces and the volumes of cells: int N_a dA, int N_a dV by Gauss points.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>

namespace muldi::fem {

/// A Gauss point of a face: shape functions, their derivatives, and the tangents that these give.
struct FacePoint {
  Eigen::Vector4d N, N_xi, N_eta;
  Eigen::Vector3d along, across;
};

/// Calls use(point) at the four Gauss points of a face, at positions x (three a node).
template <class Use>
void each_face_tangent(const std::array<int, 4>& face, const double* x, const Use& use) {
  Eigen::Matrix<double, 3, 4> corner;
  for (int a = 0; a < 4; ++a) {
    corner.col(a) =
        Eigen::Map<const Eigen::Vector3d>(x + 3 * static_cast<std::ptrdiff_t>(face[static_cast<std::size_t>(a)]));
  }
  const double gauss = 1.0 / std::sqrt(3.0);
  for (const double xi : {-gauss, gauss}) {
    for (const double eta : {-gauss, gauss}) {
      FacePoint at;
      at.N << 0.25 * (1 - xi) * (1 - eta), 0.25 * (1 + xi) * (1 - eta), 0.25 * (1 + xi) * (1 + eta),
          0.25 * (1 - xi) * (1 + eta);
      at.N_xi << -0.25 * (1 - eta), 0.25 * (1 - eta), 0.25 * (1 + eta), -0.25 * (1 + eta);
      at.N_eta << -0.25 * (1 - xi), -0.25 * (1 + xi), 0.25 * (1 + xi), 0.25 * (1 - xi);
      at.along = corner * at.N_xi;
      at.across = corner * at.N_eta;
      use(at);
    }
  }
}

/// Calls use(N, da) at the four Gauss points of a face: shape functions, and the area vector (outward) that the point
/// stands for, at positions x (three a node).
template <class Use>
void each_face_point(const std::array<int, 4>& face, const double* x, const Use& use) {
  each_face_tangent(face, x, [&use](const FacePoint& at) { use(at.N, Eigen::Vector3d(at.along.cross(at.across))); });
}

/// Of the corners of a face, counterclockwise; X: positions (3 n_nodes).
std::array<double, 4> area_shares(const std::array<int, 4>& face, const Eigen::VectorXd& X);
/// Of the corners of a cell in VTK's order.
std::array<double, 8> volume_shares(const std::array<int, 8>& cell, const Eigen::VectorXd& X);

}  // namespace muldi::fem
