#include "math/coupled_preconditioner.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "math/vector_loops.hpp"

namespace muldi::math {
namespace {

constexpr int n_displacements = 3;

}  // namespace

CoupledPreconditioner::CoupledPreconditioner(const SymmetricBlockPattern& pattern, BlockChebyshev::Degrees degrees)
    : block_size_(pattern.block_size()), displacement_(pattern, n_displacements, degrees) {
  MULDI_EXPECT(block_size_ == 3 || block_size_ == 4, "three displacements and at most one potential");
}

bool CoupledPreconditioner::update(const SymmetricBlockMatrix& matrix, bool new_potential) {
  if (block_size_ == 4 && (!potential_ || new_potential)) set_up_potential(matrix);
  return displacement_.update(matrix);
}

void CoupledPreconditioner::set_up_potential(const SymmetricBlockMatrix& matrix) {
  DoubleCsr laplacian = component_matrix(matrix, n_displacements, 1.0);
  const auto is_constrained = [&](int i) {
    return laplacian.start[static_cast<std::size_t>(i) + 1] - laplacian.start[static_cast<std::size_t>(i)] == 1;
  };
  r_.setZero(laplacian.n_rows);
  z_.setZero(laplacian.n_rows);
  row_signs_.setZero(laplacian.n_rows);
  sign_ = 1.0;
  for (int i = 0; i < laplacian.n_rows; ++i) {
    laplacian.for_row(i, [&](int j, double value) {
      if (i == j) row_signs_(i) = value < 0.0 ? -1.0F : 1.0F;
    });
    if (!is_constrained(i)) sign_ = static_cast<double>(row_signs_(i));
  }
  // The diagonal of a constrained row may have any sign.
  for (int i = 0; i < laplacian.n_rows; ++i) {
    const double factor = is_constrained(i) ? static_cast<double>(row_signs_(i)) : sign_;
    for (int e = laplacian.start[static_cast<std::size_t>(i)]; e < laplacian.start[static_cast<std::size_t>(i) + 1];
         ++e) {
      laplacian.values[static_cast<std::size_t>(e)] *= factor;
    }
  }
  potential_.emplace(std::move(laplacian));
}

void CoupledPreconditioner::apply(const Eigen::VectorXd& r, Eigen::VectorXd& z, PotentialSign sign) {
  displacement_.apply(r, block_size_, z);
  if (!potential_) return;
  const bool keeps_sign = sign == PotentialSign::of_the_matrix;
  for_vector_chunks(r_.size(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    for (std::ptrdiff_t i = first; i < first + n; ++i) r_(i) = static_cast<float>(r(4 * i + 3));
  });
  potential_->apply(r_, z_);
  for_vector_chunks(r_.size(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    for (std::ptrdiff_t i = first; i < first + n; ++i) {
      z(4 * i + 3) = static_cast<double>(keeps_sign ? row_signs_(i) * z_(i) : z_(i));
    }
  });
}

}  // namespace muldi::math
