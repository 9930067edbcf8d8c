#include "fem/solid/field_peaks.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.hpp"
#include "fem/mesh/mesh.hpp"

namespace muldi::fem {
namespace {

using Gradients = Eigen::Matrix<double, 8, 3>;

/// Derivatives of the shape functions by reference coordinates at the Gauss points.
std::array<Gradients, 8> gradients_at_points() {
  std::array<Gradients, 8> all;
  for (int point = 0; point < 8; ++point) {
    const Vec3 at = gauss_point(point);
    for (int a = 0; a < 8; ++a) {
      const Vec3& c = corners_of_cell[static_cast<std::size_t>(a)];
      const double u = 1 + c[0] * at[0];
      const double v = 1 + c[1] * at[1];
      const double w = 1 + c[2] * at[2];
      all[static_cast<std::size_t>(point)].row(a) << 0.125 * c[0] * v * w, 0.125 * c[1] * u * w, 0.125 * c[2] * u * v;
    }
  }
  return all;
}

}  // namespace

void field_peaks(const ElementSet& elements, const Eigen::Ref<const Eigen::VectorXd>& x,
                 const Eigen::Ref<const Eigen::VectorXd>& phi, Eigen::Ref<Eigen::VectorXd> peaks) {
  static const std::array<Gradients, 8> gradients = gradients_at_points();
  constexpr int cells_a_chunk = 512;
  const int n = elements.n_cells();
  const int n_chunks = (n + cells_a_chunk - 1) / cells_a_chunk;
  base::parallel_for(n_chunks, [&](int chunk) {
    const base::ChunkRange range = base::chunk_range(n, n_chunks, chunk);
    for (std::ptrdiff_t cell = range.first; cell < range.last; ++cell) {
      Eigen::Matrix<double, 3, 8> corner;
      Eigen::Matrix<double, 1, 8> potential;
      for (int a = 0; a < 8; ++a) {
        const auto node =
            static_cast<Eigen::Index>(elements.cells()[static_cast<std::size_t>(cell)][static_cast<std::size_t>(a)]);
        corner.col(a) = x.segment<3>(3 * node);
        potential[a] = phi[node];
      }
      double largest = 0.0;
      for (const Gradients& dN : gradients) {
        const Eigen::Matrix3d dx = corner * dN;
        largest = std::max(largest, Eigen::RowVector3d(potential * dN * dx.inverse()).squaredNorm());
      }
      peaks[cell] = std::sqrt(largest);
    }
  });
}

}  // namespace muldi::fem
