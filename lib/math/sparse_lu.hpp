#pragma once
/// General sparse LU of SuiteSparse (UMFPACK): the referee of our own factorisation, and the fallback for matrices that
/// are not symmetric or have an unexpected inertia. Slow for three-dimensional meshes.
#include <Eigen/SparseCore>
#include <memory>
#include <span>

#include "math/sparse_block_matrix.hpp"

namespace muldi::math {

/// What a factorisation found.
enum class LuOutcome {
  ok,
  singular,       ///< a pivot is zero: there is no factor
  out_of_memory,  ///< there is no factor
};

/// The matrix with both triangles, column-compressed.
Eigen::SparseMatrix<double> full_matrix(const SymmetricBlockMatrix& matrix);
/// Writes new values into what full_matrix made of a matrix with the same pattern; no search, no memory.
void refill(Eigen::SparseMatrix<double>& full, const SymmetricBlockMatrix& matrix);

/// One factor with partial pivoting; the analysis is kept while the pattern stays the same.
class SparseLu {
 public:
  /// EnvironmentError if UMFPACK is not installed.
  SparseLu();
  ~SparseLu();
  SparseLu(SparseLu&&) noexcept;
  SparseLu& operator=(SparseLu&&) noexcept;

  /// Factorises a square compressed matrix; a copy is kept, for the iterative refinement of solutions.
  LuOutcome factorise(const Eigen::SparseMatrix<double>& matrix);
  /// x = A^-1 b, after a factorisation that was ok; b and x are not the same vector.
  void solve(const Eigen::Ref<const Eigen::VectorXd>& b, Eigen::Ref<Eigen::VectorXd> x) const;
  /// Of the determinant, after a factorisation that was ok: -1 for an odd number of negative eigenvalues.
  int determinant_sign() const;
  /// Rough estimate of the reciprocal condition number (least over greatest pivot).
  double reciprocal_condition() const { return reciprocal_condition_; }

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
  double reciprocal_condition_ = 0.0;
};

}  // namespace muldi::math
