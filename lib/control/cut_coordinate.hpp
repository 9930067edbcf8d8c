#pragma once
/// The coordinate of a loop-closing joint in a row of the problem: it is no unknown, but a function of the pose.
#include "control/end_pieces.hpp"

namespace muldi::control {

/// c(q) of one node. The coordinate must outlive this.
class CutCoordinate {
 public:
  CutCoordinate(const model::EndCoordinate& coordinate, const model::Chart& chart);

  /// Coordinates theta that it depends on.
  const std::vector<int>& columns() const { return piece_.columns; }
  /// c(q) - from, of angles the short way round.
  double offset(const model::ChartPoint& at, double from) const { return piece_.coordinate->offset(at.q, from); }
  /// dc/dtheta (1, n_v).
  Eigen::RowVectorXd gradient(const model::ChartPoint& at) const;
  /// H += factor d2c/dtheta2 (n_v, n_v); of that, what the chart makes of the gradient by q goes to y (n_q).
  void add_hessian(double factor, const model::ChartPoint& at, Eigen::VectorXd& y, Eigen::MatrixXd& H) const;

 private:
  Piece piece_;
};

}  // namespace muldi::control
