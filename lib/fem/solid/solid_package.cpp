#include "fem/solid/solid_package.hpp"

#include "base/error.hpp"
#include "fem/solid/solid_factor.hpp"

namespace muldi::fem {

int factorise_with_pivoting(const Eigen::SparseMatrix<double>& full, int expected, math::SparseLu& lu) {
  const math::LuOutcome outcome = lu.factorise(full);
  if (outcome == math::LuOutcome::out_of_memory) {
    throw base::EnvironmentError("UMFPACK's factor does not fit into memory: take fewer cells, or another solver");
  }
  if (outcome == math::LuOutcome::singular || lu.reciprocal_condition() < singular_pivot) return -1;
  const int sign = expected % 2 == 0 ? 1 : -1;
  return lu.determinant_sign() == sign ? expected : expected + 1;
}

SolidPackage::SolidPackage(const math::SymmetricBlockPattern& pattern, const math::NodeMask& mask,
                           std::vector<std::vector<int>> electrodes, Package package, int expected_negative)
    : SolidLinear(pattern, mask, std::move(electrodes)),
      package_(package),
      expected_negative_(expected_negative),
      full_(math::full_matrix(matrix_)) {
  if (package == Package::cholmod) {
    cholesky_.emplace();
  } else {
    lu_.emplace();
  }
}

double SolidPackage::bytes_of(const math::SymmetricBlockPattern& pattern, Package package, int expected_negative) {
  const Eigen::SparseMatrix<double> full = math::full_matrix(math::SymmetricBlockMatrix(pattern));
  const bool definite = package == Package::umfpack || expected_negative == 0;
  const double factor = math::SparseCholesky::bytes_of(full, definite);
  // UMFPACK keeps a copy of the matrix and two triangles, and its pivots decide how full they are.
  const double matrices = package == Package::umfpack ? 2.0 : 1.0;
  return matrices * (12.0 * static_cast<double>(full.nonZeros()) + factor);
}

int SolidPackage::factorise_free() {
  matrix_.constrain(mask_, 1.0);
  math::refill(full_, matrix_);
  if (package_ == Package::umfpack) return factorise_with_pivoting(full_, expected_negative_, *lu_);
  return cholesky_->factorise(full_, expected_negative_ == 0) ? cholesky_->n_negative() : -1;
}

void SolidPackage::solve_free(Eigen::VectorXd& x) {
  rhs_ = x;
  if (package_ == Package::umfpack) {
    lu_->solve(rhs_, x);
  } else {
    cholesky_->solve(rhs_, x);
  }
}

}  // namespace muldi::fem
