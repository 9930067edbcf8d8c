#pragma once
/// Conditions on the pose at one end of the horizon, made full rank (numerics, 1.11).
///
/// Coordinates that are given are fixed. What else is asked, R(theta) = 0 - closed loops, points, directors,
/// equilibrium - may be redundant: three components of a point that turns about a hinge have rank one. At a pose that
/// fulfils all of it the left singular vectors U of dR/dtheta are kept that belong to singular values other than zero;
/// the rows of the problem are U^T R.
#include <optional>
#include <string>
#include <vector>

#include "control/cut_coordinate.hpp"
#include "control/problem.hpp"

namespace muldi::control {

/// Natural sizes of the coordinates and of forces on them.
struct NaturalSizes {
  Eigen::VectorXd theta;  ///< (n_v)
  Eigen::VectorXd mass;   ///< diagonal of D^T M D (n_v), > 0
  double length = 1.0;
  double duration = 1.0;
};

/// What the rows start from.
struct EndSetup {
  const Problem& problem;
  const EndCondition& condition;
  const PieceList& pieces;
  Eigen::VectorXd x;  ///< reference of the chart: the guess
  Eigen::MatrixXd Z;  ///< basis of the loop rows there
  NaturalSizes sizes;
  std::string where;  ///< "initial" or "final"
};

class EndRows {
 public:
  explicit EndRows(EndSetup setup);

  /// Coordinates that are given.
  const std::vector<std::optional<double>>& fixed() const { return fixed_; }
  bool all_fixed() const;
  /// Faults that the search for a pose has found; the pose, near the guess.
  const std::vector<Fault>& faults() const { return faults_; }
  const Eigen::VectorXd& pose() const { return pose_; }
  const Eigen::VectorXd& pose_multipliers() const { return pose_lambda_; }

  int n_rows() const { return static_cast<int>(U_.cols()); }
  bool has_equilibrium() const { return setup_.condition.equilibrium.has_value(); }
  /// The condition that weighs most in a row.
  const std::string& name(int row) const;

  /// Evaluates at theta and the loop multipliers of the equilibrium (n_c, or empty).
  void move_to(const Eigen::VectorXd& theta, const Eigen::VectorXd& lambda);
  /// U^T R (n_rows).
  Eigen::VectorXd values();
  /// Derivatives (n_rows, n_v) and by the multipliers (n_rows, n_c).
  Eigen::MatrixXd jacobian(Eigen::MatrixXd& by_lambda);
  /// H += d2(nu . U^T R)/dtheta2, H_lambda += d2/(dlambda dtheta).
  void add_hessian(const Eigen::VectorXd& nu, Eigen::MatrixXd& H, Eigen::MatrixXd& H_lambda);

 private:
  struct LinearRow {
    model::LinearPoint point;
    int component = 0;
    double target = 0.0;
    double scale = 1.0;
  };

  struct CutRow {
    CutCoordinate coordinate;
    double target = 0.0;
    double scale = 1.0;
  };

  void fix_coordinates();
  void list_rows();
  void scale_forces();
  void find_pose();
  void choose_rows();
  Eigen::VectorXd raw_values();
  Eigen::MatrixXd raw_jacobian(Eigen::MatrixXd& by_lambda);
  /// One damped Gauss-Newton search; the residual.
  double search(Eigen::VectorXd& theta, Eigen::VectorXd& lambda);
  Eigen::MatrixXd free_jacobian();
  void blame(const Eigen::VectorXd& residual);
  model::IntervalPoint point_at_rest() const;
  void evaluate_forces();
  /// Adds what the points, directors and coordinates of cut joints have in nu . R: weights of q, second derivatives.
  void add_pose_hessian(const Eigen::VectorXd& raw, Eigen::VectorXd& y, Eigen::MatrixXd& H) const;
  /// Scale of a raw row that is about points, directors or coordinates of cut joints; 0 of others.
  double scale_of(Eigen::Index raw_row) const;
  void add_loop_hessian(const Eigen::VectorXd& on_rows, Eigen::VectorXd& y, Eigen::MatrixXd& H,
                        Eigen::MatrixXd& H_lambda);
  Eigen::MatrixXd stiffness();

  EndSetup setup_;
  const model::Model& model_;
  std::unique_ptr<model::Chart> chart_;
  Eigen::Index n_v_ = 0;
  Eigen::Index n_loop_ = 0;  // rows of the loops
  std::vector<std::optional<double>> fixed_;
  std::vector<LinearRow> linear_;
  std::vector<CutRow> cut_;                // after the linear ones
  std::vector<std::string> names_;         // of conditions
  std::vector<std::size_t> condition_of_;  // of raw rows
  Eigen::VectorXd force_scale_;
  Eigen::MatrixXd U_;
  std::vector<std::size_t> condition_of_row_;
  Eigen::VectorXd pose_;
  Eigen::VectorXd pose_lambda_;
  std::vector<Fault> faults_;

  model::ChartPoint point_;
  Eigen::VectorXd theta_;
  Eigen::VectorXd x_;
  Eigen::VectorXd lambda_;  // (n_c)
  Eigen::VectorXd zero_q_;
  Eigen::VectorXd zero_v_;
  model::IntervalForces forces_;
  Eigen::VectorXd bracket_;  // forces of the equilibrium, those of the loops included
  std::vector<double> no_squares_;
};

}  // namespace muldi::control
