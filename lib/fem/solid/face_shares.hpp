#pragma once
/// Shares of nodes in the areas of faces and the volumes of cells: int N_a dA, int N_a dV by Gauss points.
#include <Eigen/Core>
#include <array>

namespace muldi::fem {

/// Of the corners of a face, counterclockwise; X: positions (3 n_nodes).
std::array<double, 4> area_shares(const std::array<int, 4>& face, const Eigen::VectorXd& X);
/// Of the corners of a cell in VTK's order.
std::array<double, 8> volume_shares(const std::array<int, 8>& cell, const Eigen::VectorXd& X);

}  // namespace muldi::fem
