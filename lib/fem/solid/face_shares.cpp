#include "fem/solid/face_shares.hpp"

#include <Eigen/LU>

#include "fem/mesh/mesh.hpp"

namespace muldi::fem {
std::array<double, 4> area_shares(const std::array<int, 4>& face, const Eigen::VectorXd& X) {
  std::array<double, 4> shares{};
  each_face_point(face, X.data(), [&shares](const Eigen::Vector4d& N, const Eigen::Vector3d& da) {
    const double area = da.norm();
    for (int a = 0; a < 4; ++a) shares[static_cast<std::size_t>(a)] += N[a] * area;
  });
  return shares;
}

std::array<double, 8> volume_shares(const std::array<int, 8>& cell, const Eigen::VectorXd& X) {
  Eigen::Matrix<double, 3, 8> x;
  for (int a = 0; a < 8; ++a) x.col(a) = X.segment<3>(3 * static_cast<Eigen::Index>(cell[static_cast<std::size_t>(a)]));
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
