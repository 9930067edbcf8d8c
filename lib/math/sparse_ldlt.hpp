#pragma once
/// Multifrontal L S L^T factorisation of symmetric block matrices without pivoting, S = diag(+-1).
///
/// For positive definite and symmetric quasi-definite matrices, whose factorisation exists in every order (Vanderbei
/// 1995, SIAM J. Optim. 5). Every other symmetric matrix is tried: signs and sizes of the pivots are reported, and the
/// caller judges whether the factor is the one that it expects.
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "math/sparse_block_matrix.hpp"
#include "math/sparse_ldlt_analysis.hpp"

namespace muldi::math {

/// How the factor is kept. Factorisations always compute in double precision.
enum class FactorStorage {
  double_precision,
  single_precision  ///< half the memory and traffic; solves are good to about 1e-6, for iterations with exact residuals
};

/// What a factorisation found.
struct LdltOutcome {
  bool ok = false;      ///< false: a pivot was zero (or no number) and there is no factor
  int zero_pivot = -1;  ///< its unknown in the matrix, -1 if none
  int n_negative = 0;   ///< negative pivots, constrained unknowns not counted: the inertia
  /// Least and greatest |pivot| / |diagonal entry of the matrix|, free of the unknowns' scales. A tiny least one means
  /// cancellation. The greatest one is at most 1 for definite matrices.
  double smallest_ratio = 1.0;
  double largest_ratio = 0.0;
};

/// One factor with its work space. No memory is requested after the first factorisation, and none by solves of as many
/// columns as have been solved before, while base::n_threads() stays the same. Large fronts use all threads. The same
/// bits for any number of threads.
class SparseLdlt {
 public:
  /// The analysis must outlive the factor and may serve several.
  explicit SparseLdlt(const LdltAnalysis& analysis, FactorStorage storage = FactorStorage::double_precision);

  /// Factorises; rows and columns of constrained unknowns are ignored but for their diagonal.
  LdltOutcome factorise(const SymmetricBlockMatrix& matrix);
  /// x = A^-1 x, after a factorisation that was ok.
  void solve(Eigen::Ref<Eigen::VectorXd> x);
  /// The same for every column (n_rows x n).
  void solve_columns(Eigen::Ref<Eigen::MatrixXd> x);

  const LdltAnalysis& analysis() const { return *analysis_; }
  /// Bytes that the object holds now.
  std::ptrdiff_t bytes() const;

 private:
  using Front = LdltAnalysis::Front;

  void allocate();
  void assemble(const Front& front, const double* values, double* panel) const;
  void add_to_panel(const Front& front, double* panel) const;
  void add_to_update(const Front& front, double* update) const;
  bool eliminate(const Front& front, const double* values, LdltOutcome& outcome);
  template <class Scalar>
  void solve_group(const Scalar* factor, std::vector<Scalar>& work, Eigen::Ref<Eigen::MatrixXd>& x);

  const LdltAnalysis* analysis_;
  FactorStorage storage_;
  bool factorised_ = false;
  std::vector<double> factor_;
  std::vector<float> float_factor_;
  std::vector<double> signs_;
  std::vector<double> constrained_diagonal_;
  std::array<std::vector<double>, 2> stacks_;
  std::vector<double> panel_;
  std::vector<double> diagonal_;  // of the front's pivots before the elimination, then the least sizes of pivots
  std::vector<double> pack_;
  std::vector<double> work_;
  std::vector<float> float_work_;
};

}  // namespace muldi::math
