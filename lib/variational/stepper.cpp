#include "variational/stepper.hpp"

#include <algorithm>
#include <cmath>

namespace muldi::variational {
namespace {

/// Longest dimensionless Newton increment that is taken whole (rad, or sizes of the scene).
constexpr double longest_increment = 0.5;
/// Halvings of an increment that leaves the admissible configurations.
constexpr int max_halvings = 12;
/// Relative residual below which increments may stop falling: round-off of badly conditioned systems.
constexpr double round_off_residual = 1e-12;

}  // namespace

Stepper::Stepper(const model::Model& model, double dt, StepOptions options)
    : model_(model),
      manifold_(*model.manifold),
      dt_(dt),
      options_(std::move(options)),
      solver_(manifold_.make_solver(*model.pattern, options_.linear)),
      frame_n_(manifold_.make_frame()),
      frame_k_(manifold_.make_frame()),
      K_(*model.pattern),
      scale_(manifold_.rate_scale()) {
  for (Eigen::VectorXd* in_q : {&forces_.force, &forces_.momentum, &q_, &q_mid_, &v_, &bracket_, &constraint_force_}) {
    *in_q = Eigen::VectorXd::Zero(manifold_.n_q());
  }
  for (Eigen::VectorXd* in_v : {&r_, &dw_}) *in_v = Eigen::VectorXd::Zero(manifold_.n_v());
  for (Eigen::VectorXd* in_c : {&g_, &mu_, &dmu_}) *in_c = Eigen::VectorXd::Zero(manifold_.n_c());
  for (Eigen::VectorXd* of_rows : {&gaps_, &lambda_}) *of_rows = Eigen::VectorXd::Zero(manifold_.n_loop_rows());
  x_ = Eigen::VectorXd::Zero(manifold_.n_x());
  x_before_ = x_;
  const Eigen::VectorXd reference = manifold_.reference();
  manifold_.configuration(reference, q_);
  manifold_.update(reference, q_, *frame_n_);
  reference_regularity_ = manifold_.choose_loop_rows(*frame_n_).regularity;
}

model::IntervalPoint Stepper::point(const State& state, std::span<const double> u) const {
  const auto size = static_cast<std::size_t>(x_.size());
  return {.q0 = state.q,
          .q1 = q_,
          .q = q_mid_,
          .v = v_,
          .u = u,
          .dt = dt_,
          .x0 = {state.x.data(), size},
          .x1 = {x_.data(), size}};
}

void Stepper::evaluate(const State& state, std::span<const double> u) {
  manifold_.configuration(x_, q_);
  q_mid_ = 0.5 * (state.q + q_);
  v_ = (q_ - state.q) / dt_;
  model_.forces(point(state, u), forces_);
}

double Stepper::residual_of(const State& state) {
  bracket_ = state.p + 0.5 * dt_ * forces_.force - forces_.momentum;
  const double terms = std::max({state.p.lpNorm<Eigen::Infinity>(), 0.5 * dt_ * forces_.force.lpNorm<Eigen::Infinity>(),
                                 forces_.momentum.lpNorm<Eigen::Infinity>()});
  const Eigen::MatrixXd& Z = manifold_.loop_basis(*frame_n_);
  lambda_.noalias() = Z * mu_;
  manifold_.add_constraint_forces(state.q, -1.0, lambda_, bracket_);
  manifold_.project(*frame_n_, bracket_, r_);
  manifold_.constraints(q_, gaps_);
  g_.noalias() = Z.transpose() * gaps_;
  return terms > 0.0 ? r_.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>() / terms : 0.0;
}

void Stepper::damp_until_admissible(const State& state, StepReport& report) {
  double factor = 1.0;
  for (int halving = 0;; ++halving) {
    manifold_.retract(x_before_, dw_, x_);
    manifold_.configuration(x_, q_);
    q_mid_ = 0.5 * (state.q + q_);
    report.sentence = model_.inadmissible(q_mid_);
    if (report.sentence.empty()) report.sentence = model_.inadmissible(q_);
    if (report.sentence.empty() || halving == max_halvings) break;
    dw_ *= 0.5;
    factor *= 0.5;
  }
  mu_ += factor * dmu_;
}

bool Stepper::newton(const State& state, std::span<const double> u, StepReport& report) {
  double previous = 0.0;
  for (int iteration = 1; iteration <= options_.max_iterations; ++iteration) {
    evaluate(state, u);
    report.residual = residual_of(state);
    ++report.iterations;
    manifold_.update(x_, q_, *frame_k_);
    model_.tangent(point(state, u), model::TangentWeights::step(dt_), K_);
    ++report.factorisations;
    if (!solver_->factorise(*frame_n_, *frame_k_, K_)) {
      report.sentence = "the Newton matrix is singular";
      return false;
    }
    g_ = -g_;
    solver_->solve(r_, g_, dw_, dmu_);
    double size = dw_.size() > 0 ? dw_.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>() : 0.0;
    if (!std::isfinite(size)) {
      report.sentence = "the Newton increment is not finite";
      return false;
    }
    if (size > longest_increment) {
      dw_ *= longest_increment / size;
      dmu_ *= longest_increment / size;
    }
    x_before_ = x_;
    damp_until_admissible(state, report);
    if (!report.sentence.empty()) return false;
    const bool stagnates = iteration > 3 && size > 0.5 * previous && report.residual < round_off_residual;
    if (size <= options_.tolerance || stagnates) return true;
    previous = size;
  }
  report.sentence = "no convergence in " + std::to_string(options_.max_iterations) + " Newton iterations";
  return false;
}

bool Stepper::choose_loop_rows(StepReport& report) {
  const model::LoopRank rank = manifold_.choose_loop_rows(*frame_n_);
  report.loop_regularity = rank.regularity / reference_regularity_;
  if (report.loop_regularity < options_.loop_limit) {
    report.sentence = "the loop constraints lose rank: the mechanism is at a change point";
  } else if (rank.excess > options_.loop_limit) {
    report.sentence =
        "the loop constraints have a higher rank than in the scene pose, which is a change point of the mechanism: "
        "give another scene pose";
  } else {
    return true;
  }
  report.status = Status::rank_change;
  return false;
}

StepReport Stepper::advance(State& state, std::span<const double> u) {
  StepReport report;
  manifold_.update(state.x, state.q, *frame_n_);
  if (!choose_loop_rows(report)) return report;
  const double weight = state.step == 0 ? 0.5 * dt_ : dt_;
  manifold_.retract(state.x, state.increment, x_);
  mu_.noalias() = weight * manifold_.loop_basis(*frame_n_).transpose() * state.multipliers;
  manifold_.configuration(x_, q_);
  bool converged = model_.inadmissible(q_).empty() && newton(state, u, report);
  if (!converged) {
    // The predictor may be far off after a sudden change of the controls: start once more from the last node.
    report.sentence.clear();
    x_ = state.x;
    mu_.setZero();
    converged = newton(state, u, report);
  }
  if (!converged) {
    report.status = model_.inadmissible(q_).empty() && model_.inadmissible(q_mid_).empty() ? Status::no_convergence
                                                                                           : Status::muscle_collapse;
    return report;
  }
  finish(state, u, report);
  return report;
}

void Stepper::carry_residual() {
  g_.setZero();
  solver_->solve(r_, g_, dw_, dmu_);
  v_.setZero();
  manifold_.lift(*frame_k_, dw_, v_);
  K_.multiply(v_, bracket_);
}

void Stepper::finish(State& state, std::span<const double> u, StepReport& report) {
  evaluate(state, u);
  report.rotation = manifold_.largest_rotation(state.q, q_);
  if (report.rotation > options_.refuse_rotation) {
    report.status = Status::step_too_large;
    report.sentence = "a body turns by " + std::to_string(report.rotation) + " rad in one step (limit " +
                      std::to_string(options_.refuse_rotation) + "): use a smaller step";
    return;
  }
  if (manifold_.n_c() > 0) {
    manifold_.update(x_, q_, *frame_k_);
    if (manifold_.loops_cross(*frame_n_, *frame_k_)) report.loop_regularity = 0.0;
  }
  report.residual = residual_of(state);
  const double weight = state.step == 0 ? 0.5 * dt_ : dt_;
  constraint_force_ = -(state.p + 0.5 * dt_ * forces_.force - forces_.momentum) / weight;
  report.work = model_.work(point(state, u));
  manifold_.difference(state.x, x_, state.increment);
  state.multipliers = lambda_ / weight;
  carry_residual();
  state.p = forces_.momentum + 0.5 * dt_ * forces_.force + bracket_;
  state.x = x_;
  state.q = q_;
  ++state.step;
  state.t = static_cast<double>(state.step) * dt_;
}

}  // namespace muldi::variational
