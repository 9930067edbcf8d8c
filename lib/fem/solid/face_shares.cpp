#include "fem/solid/face_shares.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "fem/mesh/mesh.hpp"

namespace muldi::fem {
namespace {

const double gauss = 1.0 / std::sqrt(3.0);

template <std::size_t n>
Eigen::Matrix<double, 3, static_cast<int>(n)> corners(const std::array<int, n>& nodes, const Eigen::VectorXd& X) {
  Eigen::Matrix<double, 3, static_cast<int>(n)> result;
  for (std::size_t a = 0; a < n; ++a) {
    result.col(static_cast<int>(a)) = X.segment<3>(3 * static_cast<Eigen::Index>(nodes[a]));
  }
  return result;
}

}  // namespace

std::array<double, 4> area_shares(const std::array<int, 4>& face, const Eigen::VectorXd& X) {
  const Eigen::Matrix<double, 3, 4> x = corners(face, X);
  std::array<double, 4> shares{};
  for (const double xi : {-gauss, gauss}) {
    for (const double eta : {-gauss, gauss}) {
      const Eigen::Vector4d N(0.25 * (1 - xi) * (1 - eta), 0.25 * (1 + xi) * (1 - eta), 0.25 * (1 + xi) * (1 + eta),
                              0.25 * (1 - xi) * (1 + eta));
      const Eigen::Vector4d N_xi(-0.25 * (1 - eta), 0.25 * (1 - eta), 0.25 * (1 + eta), -0.25 * (1 + eta));
      const Eigen::Vector4d N_eta(-0.25 * (1 - xi), -0.25 * (1 + xi), 0.25 * (1 + xi), 0.25 * (1 - xi));
      const double area = Eigen::Vector3d(x * N_xi).cross(Eigen::Vector3d(x * N_eta)).norm();
      for (int a = 0; a < 4; ++a) shares[static_cast<std::size_t>(a)] += N[a] * area;
    }
  }
  return shares;
}

std::array<double, 8> volume_shares(const std::array<int, 8>& cell, const Eigen::VectorXd& X) {
  const Eigen::Matrix<double, 3, 8> x = corners(cell, X);
  std::array<double, 8> shares{};
  for (int point = 0; point < 8; ++point) {
    const Vec3 at = gauss_point(point);
    Eigen::Matrix<double, 8, 1> N;
    Eigen::Matrix<double, 8, 3> dN;
    for (int a = 0; a < 8; ++a) {
      const Vec3& c = corners_of_cell[static_cast<std::size_t>(a)];
      const double u = 1 + c[0] * at[0];
      const double v = 1 + c[1] * at[1];
      const double w = 1 + c[2] * at[2];
      N[a] = 0.125 * u * v * w;
      dN.row(a) << 0.125 * c[0] * v * w, 0.125 * c[1] * u * w, 0.125 * c[2] * u * v;
    }
    const double volume = Eigen::Matrix3d(x * dN).determinant();
    for (int a = 0; a < 8; ++a) shares[static_cast<std::size_t>(a)] += N[a] * volume;
  }
  return shares;
}

}  // namespace muldi::fem
