#pragma once
/// The matrix of a solid factorised by SuiteSparse: solvers that the user may force, and referees of our own.
#include <Eigen/SparseCore>
#include <optional>
#include <string>

#include "fem/solid/solid_linear.hpp"
#include "math/sparse_cholesky.hpp"
#include "math/sparse_lu.hpp"

namespace muldi::fem {

/// CHOLMOD: L L^T of definite matrices, L D L^T of others, with their inertia. UMFPACK: L U with pivoting, which knows
/// whether the number of negative eigenvalues is even or odd.
enum class Package { cholmod, umfpack };

class SolidPackage final : public SolidLinear {
 public:
  /// `expected_negative`: negative pivots that the potentials must have, by which a definite matrix is recognised and
  /// which UMFPACK reports if the sign of the determinant agrees. EnvironmentError without the library.
  SolidPackage(const math::SymmetricBlockPattern& pattern, const math::NodeMask& mask,
               std::vector<std::vector<int>> electrodes, Package package, int expected_negative);

  double accuracy() const override { return 0.0; }
  std::string name() const override { return name_of(package_); }
  static std::string name_of(Package package) { return package == Package::cholmod ? "cholmod" : "umfpack"; }
  /// Bytes of the factor and of the matrix with both triangles, by a symbolic analysis.
  static double bytes_of(const math::SymmetricBlockPattern& pattern, Package package, int expected_negative);

 private:
  double prepare() override { return balance_potentials(matrix_, mask_); }
  int factorise_free() override;
  void solve_free(Eigen::VectorXd& x) override;

  Package package_;
  int expected_negative_;
  Eigen::SparseMatrix<double> full_;
  std::optional<math::SparseCholesky> cholesky_;
  std::optional<math::SparseLu> lu_;
  Eigen::VectorXd rhs_;
};

/// Takes a matrix over that our own factorisation without pivoting fails on; the number of negative eigenvalues, by
/// the sign of the determinant `expected` or one more, and -1 if the matrix is singular to working precision.
int factorise_with_pivoting(const Eigen::SparseMatrix<double>& full, int expected, math::SparseLu& lu);

}  // namespace muldi::fem
