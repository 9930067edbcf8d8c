#include "fem/solid/least_stretch.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace muldi::fem {

Eigen::VectorXd least_stretches(const ElementSet& elements, const Eigen::Ref<const Eigen::VectorXd>& x) {
  using Gradient = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  std::vector<PointValues> points(8 * static_cast<std::size_t>(elements.n_cells()));
  elements.point_values({.x = x.data()}, points.data());
  Eigen::VectorXd least = Eigen::VectorXd::Constant(elements.n_cells(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Map<const Gradient> F(points[i].F);
    const Eigen::Matrix3d C = F.transpose() * F;
    const double square = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(C).eigenvalues()[0];
    double& of_cell = least[static_cast<Eigen::Index>(i / 8)];
    of_cell = std::min(of_cell, std::sqrt(std::max(0.0, square)));
  }
  return least;
}

CellStretch least_stretch(const ElementSet& elements, const Eigen::Ref<const Eigen::VectorXd>& x) {
  const Eigen::VectorXd all = least_stretches(elements, x);
  CellStretch least{.cell = 0, .stretch = std::numeric_limits<double>::infinity()};
  for (int cell = 0; cell < elements.n_cells(); ++cell) {
    // Round-off does not choose between equal cells.
    constexpr double clearly = 1.0 - 1e-9;
    if (all[cell] < clearly * least.stretch) least = {.cell = cell, .stretch = all[cell]};
  }
  return least;
}

}  // namespace muldi::fem
