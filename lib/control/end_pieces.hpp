#pragma once
/// Pieces on coordinates c(q) of loop-closing joints (model/end_coordinate.hpp) in a chart, node by node.
///
/// A force Q on c has the generalised force Q g, g = dc/dq at the node. With J = g^T D and alpha = g . a, a = D m, the
/// pair (c, alpha) takes the place of a linear form and of its value along the direction; what is curved in it adds
///
///     d2c/dtheta2 = D^T c_qq D + ...,
///     d2alpha/dtheta2 = D^T (c_qqq a) D + D^T c_qq A + A^T c_qq D + ...,
///
/// where the dots are what the chart makes of g and c_qq a as frozen weights of q and of g as that of a.
#include "control/pieces.hpp"

namespace muldi::control {

/// One such piece at one node. `along`: the point has a and A.
class EndPiece {
 public:
  EndPiece(const Piece& piece, const model::ChartPoint& point, bool along);

  /// J, and A = d alpha/dtheta, on the piece's columns (1, columns).
  Eigen::MatrixXd J() const;
  Eigen::MatrixXd A() const;
  /// alpha.
  double along() const;
  /// y += factor g (n_q).
  void add_value(double factor, Eigen::VectorXd& y) const;
  /// out += factor d2c/dtheta2 (n_v, n_v).
  void add_curvature(double factor, Eigen::MatrixXd& out) const;
  /// y += by_value g + force c_qq a (n_q); out += by_value d2c/dtheta2 + force d2 alpha/dtheta2.
  void add_curvature_along(double by_value, double force, Eigen::VectorXd& y, Eigen::MatrixXd& out) const;

 private:
  /// Rows of the piece's unknowns, columns of its coordinates.
  Eigen::MatrixXd part_of(const Eigen::MatrixXd& D) const;
  /// c_qq a.
  Eigen::VectorXd bend() const;

  const Piece& piece_;
  const model::ChartPoint& point_;
  model::EndDerivatives at_;
  Eigen::MatrixXd D_;
};

}  // namespace muldi::control
