#pragma once
/// The factorised matrix of a solid: masked unknowns, and floating electrodes as a small dense border.
///
/// Four unknowns a node (position, potential), or three where no potential is free. A floating electrode has one
/// unknown, the common potential of its nodes; its column of the matrix is the sum of theirs.
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "math/sparse_ldlt.hpp"

namespace muldi::fem {

class SolidFactor {
 public:
  /// `block_size` 3 or 4; `mask`: unknowns that are not free, those of floating electrodes included; `electrodes`:
  /// nodes of each floating electrode.
  SolidFactor(const math::SymmetricBlockPattern& pattern, const math::NodeMask& mask,
              std::vector<std::vector<int>> electrodes,
              math::FactorStorage storage = math::FactorStorage::double_precision);

  /// To be filled before `factorise`.
  math::SymmetricBlockMatrix& matrix() { return matrix_; }
  const math::SymmetricBlockMatrix& matrix() const { return matrix_; }

  /// False if the matrix is singular to working precision.
  bool factorise();
  /// Negative pivots, the border's included.
  int n_negative() const { return n_negative_; }
  /// x = A^-1 x over all unknowns of the nodes (n_nodes block_size). At the nodes of a floating electrode the entries
  /// of x are summed, and the result is common to them; masked entries come back as 0.
  void solve(Eigen::VectorXd& x);
  /// The same for every column.
  void solve_columns(Eigen::MatrixXd& x);
  const math::LdltSize& size() const { return analysis_.size(); }

 private:
  void make_border();
  double sum_over(const std::vector<int>& nodes, const Eigen::VectorXd& x) const;

  math::SymmetricBlockMatrix matrix_;
  math::LdltAnalysis analysis_;
  math::SparseLdlt factor_;
  std::vector<std::vector<int>> electrodes_;
  std::vector<Eigen::Index> masked_;  // unknowns
  Eigen::MatrixXd columns_;           // of the electrodes, full rows
  Eigen::MatrixXd responses_;         // A^-1 columns on the free unknowns
  Eigen::MatrixXd schur_;
  Eigen::MatrixXd inverse_schur_;
  Eigen::VectorXd indicator_;
  Eigen::VectorXd common_;
  Eigen::MatrixXd commons_;
  int n_negative_ = 0;
};

/// Smallest pivot, relative to the diagonal entry of the matrix, below which a matrix counts as singular.
inline constexpr double singular_pivot = 1e-14;

}  // namespace muldi::fem
