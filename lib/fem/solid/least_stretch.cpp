#include "fem/solid/least_stretch.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace muldi::fem {

CellStretch least_stretch(const ElementSet& elements, const Eigen::Ref<const Eigen::VectorXd>& x) {
  using Gradient = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  std::vector<PointValues> points(8 * static_cast<std::size_t>(elements.n_cells()));
  elements.point_values({.x = x.data()}, points.data());
  CellStretch least{.cell = 0, .stretch = std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Map<const Gradient> F(points[i].F);
    const Eigen::Matrix3d C = F.transpose() * F;
    const double stretch = std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(C).eigenvalues()[0]));
    // Round-off does not choose between equal cells.
    constexpr double clearly = 1.0 - 1e-9;
    if (stretch < clearly * least.stretch) least = {.cell = static_cast<int>(i / 8), .stretch = stretch};
  }
  return least;
}

}  // namespace muldi::fem
