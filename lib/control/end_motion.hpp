#pragma once
/// The motion at one end where it takes unknowns: rates omega and momenta m with the rows
///
///     D^T pi(q, D omega) - m = 0        and, on closed loops with free rates,  Z^T G D omega = 0:
///
/// given rates at a pose that is not fixed, and the kinetic energy 1/2 omega . m.
#include <memory>

#include "control/discrete_dynamics.hpp"

namespace muldi::control {

class EndMotionRows {
 public:
  /// `node` of the dynamics, which must outlive this; `with_loops`: the rates are unknown and keep the loops closed.
  EndMotionRows(const Problem& problem, const DiscreteDynamics& dynamics, int node, bool with_loops);

  int n_rows() const { return static_cast<int>(n_v_ + n_loop_); }
  /// At the node's current pose.
  void move_to(const Eigen::VectorXd& rates, const Eigen::VectorXd& momenta);
  Eigen::VectorXd values();
  /// By theta and by omega (n_rows, n_v); by m the first n_v rows have -1.
  void jacobian(Eigen::MatrixXd& by_theta, Eigen::MatrixXd& by_rates);
  /// nu (n_rows): adds by theta twice; writes (omega, theta).
  void add_hessian(const Eigen::VectorXd& nu, Eigen::MatrixXd& by_theta, Eigen::MatrixXd& rates_theta);

 private:
  /// d(D^T pi)/d.. of the pieces and the constant mass: by xi on q and by v.
  void tangents(Eigen::MatrixXd& by_theta, Eigen::MatrixXd& by_rates);
  model::IntervalPoint point() const;

  const Problem& problem_;
  const DiscreteDynamics& dynamics_;
  int node_ = 0;
  Eigen::Index n_v_ = 0;
  Eigen::Index n_loop_ = 0;
  std::unique_ptr<model::Chart> along_rates_;
  std::unique_ptr<model::Chart> along_nu_;
  model::ChartPoint moving_;  ///< a = v, A = dv/dtheta
  model::ChartPoint adjoint_;
  Eigen::VectorXd theta_;
  Eigen::VectorXd x_;
  Eigen::VectorXd momenta_;
  model::IntervalForces forces_;
  std::vector<double> no_controls_;
};

}  // namespace muldi::control
