#pragma once
/// One step of the midpoint variational integrator in momentum form, solved on the constraint manifold
/// (numerics, 1.5, 1.8).
///
///     T(q_n)^T [ p_n + dt/2 F - pi - G_c(q_n)^T Z mu ] = 0,   Z^T g_c(q_{n+1}) = 0,
///     F = dL/dq + f,  pi = dL/dv  at  q = (q_n + q_{n+1})/2,  v = (q_{n+1} - q_n)/dt,
///     p_{n+1} = pi + dt/2 F,
/// with the unknown q_{n+1} moved along minimal increments, Z the basis of the loop rows at q_n, and
/// Z mu = dt lambda_n (dt/2 at the first node).
#include <memory>
#include <span>

#include "model/model.hpp"
#include "variational/state.hpp"

namespace muldi::variational {

struct StepOptions {
  double tolerance = 1e-10;  ///< largest dimensionless Newton increment whose result is accepted
  int max_iterations = 30;
  std::string linear = "auto";   ///< auto | tree | dense | bordered
  double warn_rotation = 0.5;    ///< rad a step
  double refuse_rotation = 2.0;  ///< rad a step
  double loop_warning = 1e-2;    ///< loop regularity, relative to that at the start
  double loop_limit = 1e-6;      ///< below it, or with a redundant pivot above it, the rank is another
};

/// What one step reports.
struct StepReport {
  Status status = Status::running;
  std::string sentence;  ///< why it failed
  int iterations = 0;
  int factorisations = 0;
  double residual = 0.0;  ///< largest projected residual relative to the largest term of it
  model::IntervalWork work;
  double rotation = 0.0;         ///< largest turn of a body in the step (rad)
  double loop_regularity = 1.0;  ///< relative to that at the start; 0 where the step passed a change of rank
};

class Stepper {
 public:
  /// The model must outlive the stepper.
  Stepper(const model::Model& model, double dt, StepOptions options);

  /// Moves `state` one step on with the controls `u` at the middle of the interval; on failure `state` is unchanged.
  /// Allocates nothing after the first call.
  StepReport advance(State& state, std::span<const double> u);

  double dt() const { return dt_; }
  const StepOptions& options() const { return options_; }
  std::string solver_name() const { return solver_->name(); }

  /// -G^T lambda (n_q) at the node that the last step left, all constraints; the momentum form gives it as the part of
  /// the equation of motion that the free motions do not see.
  const Eigen::VectorXd& constraint_force() const { return constraint_force_; }

 private:
  void evaluate(const State& state, std::span<const double> u);
  model::IntervalPoint point(const State& state, std::span<const double> u) const;
  double residual_of(const State& state);
  /// Chooses the loop rows at frame_n_; false where their rank is not that of the scene pose.
  bool choose_loop_rows(StepReport& report);
  bool newton(const State& state, std::span<const double> u, StepReport& report);
  void damp_until_admissible(const State& state, StepReport& report);
  /// Sets bracket_ to the momentum that the rounded positions cannot take up, K T w with T_n^T K T w = r. As a part of
  /// p_{n+1} it keeps the momentum maps of far-travelled bodies to round-off of the momentum, not of the position.
  void carry_residual();
  void finish(State& state, std::span<const double> u, StepReport& report);

  const model::Model& model_;
  const model::Manifold& manifold_;
  double dt_;
  StepOptions options_;
  std::unique_ptr<model::ProjectedSolver> solver_;
  std::unique_ptr<model::Frame> frame_n_;
  std::unique_ptr<model::Frame> frame_k_;
  math::BlockMatrix K_;
  model::IntervalForces forces_;
  Eigen::VectorXd x_;  // iterate of x_{n+1}
  Eigen::VectorXd q_;  // iterate of q_{n+1}
  Eigen::VectorXd q_mid_;
  Eigen::VectorXd v_;
  Eigen::VectorXd x_before_;  // the iterate before the current increment
  Eigen::VectorXd bracket_;   // p_n + dt/2 F - pi - G^T Z mu
  Eigen::VectorXd r_;
  Eigen::VectorXd scale_;
  Eigen::VectorXd gaps_;    // g of all loop rows
  Eigen::VectorXd g_;       // Z^T gaps
  Eigen::VectorXd mu_;      // multipliers of the combined rows
  Eigen::VectorXd lambda_;  // Z mu
  Eigen::VectorXd dw_;
  Eigen::VectorXd dmu_;
  Eigen::VectorXd constraint_force_;
  double reference_regularity_ = 1.0;
};

}  // namespace muldi::variational
