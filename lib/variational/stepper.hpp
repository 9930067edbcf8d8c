#pragma once
/// One step of the midpoint variational integrator in momentum form, solved on the constraint manifold
/// (numerics, 1.5, 1.8).
///
///     T(q_n)^T [ p_n + dt/2 F - pi - G_c(q_n)^T Z mu ] + dt/2 Q = 0,   Z^T g_c(q_{n+1}) = 0,
///     F = dL/dq + f,  pi = dL/dv  at  q = (q_n + q_{n+1})/2,  v = (q_{n+1} - q_n)/dt,
///     Q: forces on the minimal rates, of joint coordinates (x_n + x_{n+1})/2 with the rates (x_{n+1} - x_n)/dt,
///     p_{n+1} = pi + dt/2 F + dt/2 f_Q,  T(q_{n+1})^T f_Q = Q,
/// with the unknown q_{n+1} moved along minimal increments, Z the basis of the loop rows at q_n, and
/// Z mu = dt lambda_n (dt/2 at the first node). Some terms add to the bracket what depends on q_n itself and to p_{n+1}
/// what depends on q_{n+1}; substructures add stage rows. Newton's matrix is exact for bodies and muscles; that of
/// substructures is factorised once and kept while that pays (FactorUse) and the increments keep falling (performance:
/// a lagged factor with exact residuals); where they do not fall with a new factor either, its exact derivative is
/// used.
#include <memory>
#include <span>
#include <vector>

#include "model/model.hpp"
#include "model/substructure_set.hpp"
#include "variational/contraction.hpp"
#include "variational/step_method.hpp"

namespace muldi::variational {

struct StepOptions {
  double tolerance = 1e-10;  ///< largest dimensionless Newton increment whose result is accepted (Contraction)
  int max_iterations = 30;
  std::string linear = "auto";         ///< auto | tree | dense | bordered
  std::string substructures = "auto";  ///< solver of the substructures: auto | direct | iterative | a named one
  double warn_rotation = 0.5;          ///< rad a step
  double refuse_rotation = 2.0;        ///< rad a step
  double loop_warning = 1e-2;          ///< loop regularity, relative to that at the start
  double loop_limit = 1e-6;            ///< below it, or with a redundant pivot above it, the rank is another
};

class Stepper final : public StepMethod {
 public:
  /// The model must outlive the stepper.
  Stepper(const model::Model& model, double dt, StepOptions options);

  /// Allocates nothing after the first call.
  StepReport advance(State& state, std::span<const double> u) override;

  double dt() const { return dt_; }
  const StepOptions& options() const { return options_; }
  std::string solver_name() const { return solver_->name(); }

  const Eigen::VectorXd& constraint_force() const override { return constraint_force_; }

 private:
  /// From where and with which factors of the substructures a step is tried.
  struct Attempt {
    bool extrapolate = true;   ///< start from the repeated last increment, else from the last node
    bool keep_factors = true;  ///< as long as the increments fall; else new ones in every iteration
  };

  bool attempt(const State& state, std::span<const double> u, Attempt how, StepReport& report);
  void start_at(const State& state, bool extrapolate, std::span<const double> u);
  /// Forces at the iterate x_, q_.
  void evaluate(const State& state, std::span<const double> u);
  model::IntervalPoint point(const State& state, std::span<const double> u) const;
  double residual_of(const State& state);
  /// r_ from bracket_ and the forces on the minimal rates.
  void project_bracket();
  /// Chooses the loop rows at frame_n_; false where their rank is not that of the scene pose.
  bool choose_loop_rows(StepReport& report);
  bool newton(const State& state, std::span<const double> u, bool keep_factors, StepReport& report);
  /// Tangent, factors and the increment dw_, dmu_, dq_, dy_; its size is NaN on failure.
  Increment solve(const State& state, std::span<const double> u, StepReport& report);
  /// Takes the increment, halved until the terms can be evaluated.
  void apply_increment(const State& state, StepReport& report);
  /// Halves the increment once more; false if it has been halved too often.
  bool retreat(StepReport& report);
  void move();
  void scale_increment(double factor);
  bool factorise_parts(const model::IntervalPoint& at, StepReport& report);
  /// After a restart: the factors that the unbroken run had.
  void restore_factors(const State& state, std::span<const double> u);
  /// Sets bracket_ to the momentum that the rounded positions cannot take up, K T w + f_Dw with T_n^T K T w + D w = r.
  /// As a part of p_{n+1} it keeps the momentum maps of far-travelled bodies to round-off of the momentum, not of the
  /// position. The rows of substructures keep their residual, so that momentum is kept whatever the tolerance.
  void carry_residual();
  void finish(State& state, std::span<const double> u, StepReport& report);
  /// Status and sentence of a step that failed: what cannot be evaluated, or no convergence.
  void blame(StepReport& report) const;

  const model::Model& model_;
  const model::Manifold& manifold_;
  double dt_;
  StepOptions options_;
  std::unique_ptr<model::ProjectedSolver> solver_;
  model::SubstructureSet parts_;
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
  Eigen::VectorXd diagonal_;  // derivatives of the forces on the minimal rates
  Eigen::VectorXd scale_;
  Eigen::VectorXd gaps_;    // g of all loop rows
  Eigen::VectorXd g_;       // Z^T gaps
  Eigen::VectorXd mu_;      // multipliers of the combined rows
  Eigen::VectorXd lambda_;  // Z mu
  Eigen::VectorXd dw_;
  Eigen::VectorXd dmu_;
  Eigen::VectorXd constraint_force_;
  Eigen::VectorXd y_;  // iterate of the stage unknowns
  Eigen::VectorXd y_before_;
  Eigen::VectorXd mu_before_;
  Eigen::VectorXd q_before_;
  Eigen::VectorXd dq_;
  Eigen::VectorXd dy_;
  Eigen::VectorXd rest_;  // residual rows of substructures
  std::vector<double> u_last_;
  std::vector<double> u_end_;
  FactorPoint factor_;
  bool wants_factor_ = true;
  bool exact_ = false;      // increments of substructures by their exact derivatives, not by their factors alone
  double accuracy_ = 0.0;   // of such increments
  bool evaluated_ = false;  // forces_ are those of the iterate
  int halvings_ = 0;
  std::string inverted_;  // what the iterates of this attempt ran into
  double reference_regularity_ = 1.0;
};

}  // namespace muldi::variational
