#pragma once
/// Path limits that are rows of the problem: coordinates of loop-closing joints and point boxes at the nodes, fields
/// and pull-in margins of muscles at both ends of every interval, under its control.
///
/// With E^2 = kappa(w) a muscle's row is alpha(z) + kappa beta(z): (E Z/z)^2/e_max^2 <= 1, or Pi''(z, E)/Pi''(Z, 0) >=
/// margin.
#include <string>
#include <vector>

#include "control/cut_coordinate.hpp"
#include "control/discrete_dynamics.hpp"

namespace muldi::control {

/// One row with what it depends on.
struct LimitRow {
  std::string name;
  double lower = -infinity;
  double upper = infinity;
  int node = 0;
  int interval = -1;  ///< of the control; -1 for points
  int choice = -1;    ///< control that is sought; -1: none
  int muscle = -1;
  bool is_margin = false;
  int cut = -1;  ///< of the coordinates of cut joints
  double from = 0.0;
  model::LinearPoint point = {};
  int component = 0;
  double scale = 1.0;
};

/// Value and derivatives of one row by theta of its node and by w.
struct LimitDerivatives {
  double value = 0.0;
  Eigen::RowVectorXd by_theta;
  double by_w = 0.0;
};

class LimitRows {
 public:
  LimitRows(const Problem& problem, const Layout& layout, const model::Chart& chart, double length);

  const std::vector<LimitRow>& rows() const { return rows_; }
  /// Coordinates theta that a row depends on.
  const std::vector<int>& columns(std::size_t row) const { return columns_[row]; }

  double value(const LimitRow& row, const DiscreteDynamics& dynamics, double w) const;
  LimitDerivatives derivatives(const LimitRow& row, const DiscreteDynamics& dynamics, double w) const;
  /// Adds factor times the second derivatives; what is frozen in the chart goes to y.
  void add_hessian(const LimitRow& row, double factor, const DiscreteDynamics& dynamics, double w,
                   DynamicsHessian& out) const;

 private:
  struct Length {
    double z;
    Eigen::Vector3d n;
  };
  /// alpha + kappa beta with derivatives by z, kappa with those by w.
  struct Parts {
    std::array<double, 3> alpha;
    std::array<double, 3> beta;
    std::array<double, 3> kappa;
  };
  void add_cut_rows(const PathLimits& limits, const model::Chart& chart, double length);
  void add_muscle_rows(const PathLimits& limits);
  Length length(const model::LimitedMuscle& muscle, const Eigen::VectorXd& q) const;
  Parts parts(const LimitRow& row, double z, const DiscreteDynamics& dynamics, double w) const;
  /// dz/dtheta.
  Eigen::RowVectorXd slope(const model::LimitedMuscle& muscle, const Length& at, const Eigen::MatrixXd& D) const;

  const Problem& problem_;
  int n_steps_ = 0;
  std::vector<CutCoordinate> cut_;
  std::vector<model::LimitedMuscle> muscles_;
  std::vector<int> choice_of_muscle_;
  std::vector<LimitRow> rows_;
  std::vector<std::vector<int>> columns_;
};

}  // namespace muldi::control
