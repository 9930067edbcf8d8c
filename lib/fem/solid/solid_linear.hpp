#pragma once
/// A matrix of a solid that can be solved with: masked unknowns, and floating electrodes as a small dense border.
///
/// Four unknowns a node (position, potential), or three where no potential is free. A floating electrode has one
/// unknown, the common potential of its nodes; its column of the matrix is the sum of theirs.
#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "fem/solid/bonds.hpp"
#include "math/sparse_block_matrix.hpp"

namespace muldi::fem {

/// Sizes of positions and potentials differ by orders: their diagonals are made alike. The factor that rows and columns
/// of the potentials have been multiplied by, a power of two.
double balance_potentials(math::SymmetricBlockMatrix& matrix, const math::NodeMask& mask);

class SolidLinear {
 public:
  /// `block_size` of the pattern 3 or 4; `mask`: unknowns that are not free, those of floating electrodes included;
  /// `electrodes`: nodes of each floating electrode.
  SolidLinear(const math::SymmetricBlockPattern& pattern, const math::NodeMask& mask,
              std::vector<std::vector<int>> electrodes);
  virtual ~SolidLinear() = default;
  SolidLinear(const SolidLinear&) = delete;
  SolidLinear& operator=(const SolidLinear&) = delete;

  /// Right sides are gathered from bonded nodes, and solutions followed by them; the matrix is to be folded before it
  /// is factorised. `bonds` must outlive the object.
  void respect(const Bonds& bonds) { bonds_ = bonds.empty() ? nullptr : &bonds; }

  /// To be filled before `factorise`, which may change it.
  math::SymmetricBlockMatrix& matrix() { return matrix_; }
  const math::SymmetricBlockMatrix& matrix() const { return matrix_; }

  /// Takes the matrix over; false if it is singular to working precision.
  bool factorise();
  /// Negative pivots, the border's included.
  int n_negative() const { return n_negative_; }
  /// x = A^-1 x over all unknowns of the nodes (n_nodes block_size). At the nodes of a floating electrode the entries
  /// of x are summed, and the result is common to them; masked entries come back as 0.
  void solve(Eigen::VectorXd& x);
  /// The same for every column.
  void solve_columns(Eigen::MatrixXd& x);
  /// Relative accuracy of solves.
  virtual double accuracy() const = 0;
  virtual std::string name() const = 0;

 protected:
  /// Prepares the matrix before its border is taken from it; `scale` multiplies rows and columns of the potentials.
  virtual double prepare() { return 1.0; }
  /// Takes over the matrix without the border; its negative pivots, -1 if it is singular.
  virtual int factorise_free() = 0;
  /// x = A^-1 x, masked entries zero before and ignored after.
  virtual void solve_free(Eigen::VectorXd& x) = 0;
  /// The same for every column.
  virtual void solve_free_columns(Eigen::MatrixXd& x);
  static void scale_potentials(double factor, Eigen::Ref<Eigen::MatrixXd> x);

  math::SymmetricBlockMatrix matrix_;
  math::NodeMask mask_;

 private:
  void make_border();
  /// x = A^-1 x from the solutions x without the border and `common`, the sums of the right sides at the electrodes.
  void add_border(Eigen::MatrixXd& common, Eigen::Ref<Eigen::MatrixXd> x);
  double sum_over(const std::vector<int>& nodes, const Eigen::VectorXd& x) const;

  const Bonds* bonds_ = nullptr;
  std::vector<std::vector<int>> electrodes_;
  std::vector<Eigen::Index> masked_;  // unknowns
  double scale_ = 1.0;                // of the potentials
  Eigen::MatrixXd columns_;           // of the electrodes, full rows
  Eigen::MatrixXd responses_;         // A^-1 columns on the free unknowns
  Eigen::MatrixXd schur_;
  Eigen::MatrixXd inverse_schur_;
  Eigen::VectorXd indicator_;
  Eigen::MatrixXd common_;  // of the electrodes, a column for each right side
  int n_negative_ = 0;
};

}  // namespace muldi::fem
