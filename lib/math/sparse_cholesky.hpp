#pragma once
/// Symmetric factors of SuiteSparse (CHOLMOD): supernodal L L^T of definite matrices, simplicial L D L^T of others.
///
/// The referee of our own factorisation, and a solver that users may ask for.
#include <Eigen/SparseCore>
#include <memory>
#include <span>

namespace muldi::math {

class SparseCholesky {
 public:
  /// EnvironmentError if CHOLMOD is not installed.
  SparseCholesky();
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;

  /// Factorises a compressed symmetric matrix of which the upper triangle is read; the analysis is kept, so that later
  /// matrices have the same pattern. `definite`: what is tried first; a matrix that is not falls back on L D L^T, which
  /// exists for quasi-definite matrices in every order. False if a pivot is zero. EnvironmentError if memory runs out.
  bool factorise(const Eigen::SparseMatrix<double>& matrix, bool definite);
  /// Negative pivots of the factor: the inertia.
  int n_negative() const;
  /// x = A^-1 b, after a factorisation that was ok; b and x are not the same vector.
  void solve(const Eigen::Ref<const Eigen::VectorXd>& b, Eigen::Ref<Eigen::VectorXd> x) const;
  /// Bytes of the factor of a matrix with this pattern, by an analysis alone.
  static double bytes_of(const Eigen::SparseMatrix<double>& matrix, bool definite);

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

}  // namespace muldi::math
