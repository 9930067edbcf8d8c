#pragma once
/// What a solid answers to the motion of the bodies that it is tied to, by its factor and in the frame of it.
///
/// Column j moves unknown j of the bodies by 1: W_j are the displacements and potentials of all nodes (A e_j at the
/// tied ones), P_j the pressures. By symmetry the same columns take a residual of the solid to the rows of the bodies,
/// W^T b + P^T h, and the stiffness that the eliminated solid leaves is S = W^T K W.
#include <Eigen/Core>

#include "fem/solid/ties.hpp"
#include "fem/solid/turning.hpp"
#include "math/block_matrix.hpp"
#include "math/sparse_ldlt.hpp"

namespace muldi::fem {

class TiedResponses {
 public:
  /// `n_rows`: unknowns of the factor, `block` a node; `n_pressures`: element pressures. `data` must outlive the
  /// object. Columns in single precision are for iterations with exact residuals, as the factor beside them.
  TiedResponses(const SolidDescription& data, Eigen::Index n_rows, int block, Eigen::Index n_pressures,
                math::FactorStorage storage);

  bool empty() const { return ties_.empty(); }
  int n_columns() const { return ties_.n_columns(); }
  /// Displacements and potentials (n_rows, n_columns), pressures (n_pressures, n_columns); to be filled by the solver,
  /// the former starting from `impose`.
  Eigen::MatrixXd& displacements() { return W_; }
  Eigen::MatrixXd& pressures() { return P_; }
  /// Fills W with A: the tied nodes moved, the others held.
  void impose();
  /// Makes S once all columns are there.
  void condense(const math::SymmetricBlockMatrix& K);
  /// S between the unknowns of the bodies, in the frame of the factor.
  const Eigen::MatrixXd& stiffness() const { return S_; }

  /// Computes W^T b + P^T h, and turns it and S with the bodies.
  void answer(const Turning& turning, const Eigen::VectorXd& b, const Eigen::VectorXd& h);
  /// Adds the answer to the rows of the bodies (n_q).
  void add_to_bodies(Eigen::VectorXd& rows) const;
  /// Adds S as it was turned last to the blocks of the bodies.
  void add_condensed(math::BlockMatrix& K) const;
  /// Reads the increments of the bodies from dq (n_q), for the next two.
  void read_bodies(const Turning& turning, const Eigen::VectorXd& dq);
  /// x += W dq, p += P dq.
  void add_displacements(Eigen::VectorXd& x);
  void add_pressures(Eigen::VectorXd& p);

 private:
  const SolidDescription* data_;
  Ties ties_;
  int block_;
  Eigen::MatrixXd W_;
  Eigen::MatrixXd P_;
  Eigen::MatrixXd S_;
  Eigen::MatrixXd turned_S_;
  Eigen::VectorXd answer_;  // (n_columns)
  Eigen::MatrixXd KW_;
  Eigen::VectorXd of_bodies_;  // (n_columns)
  math::FactorStorage storage_;
  Eigen::MatrixXf float_W_;
  Eigen::MatrixXf float_P_;
  Eigen::VectorXf float_rows_;
  Eigen::VectorXf float_pressures_;
  Eigen::VectorXf float_columns_;
};

}  // namespace muldi::fem
