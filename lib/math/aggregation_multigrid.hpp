#pragma once
/// Algebraic multigrid by smoothed aggregation (Vanek, Mandel and Brezina 1996, Computing 56) for scalar Laplacians.
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "math/csr_matrix.hpp"

namespace muldi::math {

/// A symmetric positive definite V-cycle in single precision, set up once for a matrix and then applied.
///
/// Both smoothings are Chebyshev polynomials of D^-1 A; rows without off-diagonal entries (constrained unknowns) are
/// solved exactly. The same bits for any number of threads.
class AggregationMultigrid {
 public:
  /// `matrix`: symmetric positive definite, mostly negative off-diagonal entries. ContractError for a diagonal entry
  /// that is not positive.
  explicit AggregationMultigrid(DoubleCsr matrix);

  int n_rows() const { return levels_.front().matrix.n_rows; }
  int n_levels() const { return static_cast<int>(levels_.size()); }
  /// Entries of all matrices over those of the first.
  double operator_complexity() const;
  /// x ~ A^-1 b by one cycle; requests no memory.
  void apply(const Eigen::VectorXf& b, Eigen::VectorXf& x);

 private:
  struct Level {
    FloatCsr matrix;
    FloatCsr prolongation;  // from the next level; empty on the last
    FloatCsr restriction;
    Eigen::VectorXf inverse_diagonal;
    double largest_eigenvalue = 2.0;  // of D^-1 A
    Eigen::VectorXf x, b, r, d;
  };
  void add_level(const DoubleCsr& matrix, double largest_eigenvalue);
  static void smooth(Level& level, const Eigen::VectorXf& b, Eigen::VectorXf& x, bool from_zero);
  void cycle(std::size_t l, const Eigen::VectorXf& b, Eigen::VectorXf& x);

  std::vector<Level> levels_;
  Eigen::LLT<Eigen::MatrixXd> coarsest_;
  Eigen::VectorXd coarsest_x_;
};

}  // namespace muldi::math
