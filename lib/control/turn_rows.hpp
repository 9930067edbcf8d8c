#pragma once
/// Rows against turns of more than an angle from node to node (PathLimits::longest_turn).
///
/// Of joint angles the change itself. Rotation vectors of balls are measured from references of their own at every node
/// and cannot be subtracted: of the bodies that depend on them the rotation between the nodes, by the directors:
///
///     sum_i d_i(n) . d_i(n+1) = trace(R_n^T R_{n+1}) = 1 + 2 cos(angle).
#include <vector>

#include "control/discrete_dynamics.hpp"

namespace muldi::control {

class TurnRows {
 public:
  /// No row where `longest` is infinite.
  TurnRows(const model::Model& model, const model::Chart& chart, const Eigen::VectorXd& pose, double longest);

  /// In every interval.
  int n_rows() const { return static_cast<int>(rows_.size()); }
  double lower(int row) const;
  double upper(int row) const;
  /// Coordinates of either node that a row depends on.
  const std::vector<int>& columns(int row) const { return at(row).columns; }

  double value(int row, int interval, const DiscreteDynamics& dynamics) const;
  /// By the columns of the begin and of the end.
  void derivatives(int row, int interval, const DiscreteDynamics& dynamics, Eigen::VectorXd& by_begin,
                   Eigen::VectorXd& by_end) const;
  /// Adds factor times the second derivatives; what is frozen in the charts goes to y.
  void add_hessian(int row, int interval, double factor, const DiscreteDynamics& dynamics, DynamicsHessian& out) const;

 private:
  struct Row {
    int angle = -1;      ///< coordinate
    int directors = -1;  ///< first of nine entries of q
    std::vector<int> columns = {};
  };
  const Row& at(int row) const { return rows_[static_cast<std::size_t>(row)]; }

  double longest_;
  std::vector<Row> rows_;
};

}  // namespace muldi::control
