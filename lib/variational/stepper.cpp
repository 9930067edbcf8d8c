#include "variational/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/mutation.hpp"
#include "base/text.hpp"

namespace muldi::variational {
namespace {

using base::has;
using base::Mutation;

/// Longest dimensionless Newton increment that is taken whole (rad, or sizes of the scene).
constexpr double longest_increment = 0.5;
/// Halvings of an increment that leaves the admissible configurations.
constexpr int max_halvings = 12;
/// Accuracy of increments with exact derivatives: that of their own size, between these.
constexpr double coarsest_accuracy = 1e-2;
constexpr double finest_accuracy = 1e-6;
/// Steps that use them from the start after one that needed them.
constexpr int exact_for_steps = 16;
/// Violation of the constraints inside substructures that one more iteration takes to round-off.
constexpr double violation_goal = 1e-12;
/// Violation that is round-off already.
constexpr double violation_round_off = 2e-13;
/// Share of an interval's forces on the minimal rates that acts at either end.
constexpr double share_of_an_end = has(Mutation::forces_without_half) ? 1.0 : 0.5;

}  // namespace

Stepper::Stepper(const model::Model& model, double dt, StepOptions options)
    : model_(model),
      manifold_(*model.manifold),
      dt_(dt),
      options_(std::move(options)),
      solver_(manifold_.make_solver(*model.pattern, options_.linear)),
      parts_(model, model::Linearisation::step, options_.substructures),
      frame_n_(manifold_.make_frame()),
      frame_k_(manifold_.make_frame()),
      K_(*model.pattern),
      scale_(manifold_.rate_scale()),
      u_last_(model.controls.size()),
      u_end_(model.controls.size()) {
  for (Eigen::VectorXd* in_q : {&forces_.force, &forces_.momentum, &q_, &q_mid_, &v_, &bracket_, &constraint_force_}) {
    *in_q = Eigen::VectorXd::Zero(model.n_q());
  }
  for (Eigen::VectorXd* in_v : {&r_, &dw_, &forces_.on_rates, &diagonal_})
    *in_v = Eigen::VectorXd::Zero(manifold_.n_v());
  for (Eigen::VectorXd* in_c : {&g_, &mu_, &dmu_}) *in_c = Eigen::VectorXd::Zero(manifold_.n_c());
  for (Eigen::VectorXd* of_rows : {&gaps_, &lambda_}) *of_rows = Eigen::VectorXd::Zero(manifold_.n_loop_rows());
  if (model.acts_at_ends()) forces_.begin = forces_.end = q_;
  if (!parts_.empty()) {
    for (Eigen::VectorXd* in_q : {&q_before_, &dq_, &rest_}) *in_q = q_;
    for (Eigen::VectorXd* in_y : {&forces_.stage, &y_, &y_before_, &dy_}) *in_y = Eigen::VectorXd::Zero(model.n_y());
  }
  x_ = Eigen::VectorXd::Zero(manifold_.n_x());
  x_before_ = x_;
  mu_before_ = mu_;
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
          .x1 = {x_.data(), size},
          .y = &y_,
          .first = state.step == 0};
}

void Stepper::evaluate(const State& state, std::span<const double> u) {
  parts_.place({.u = u, .u_end = u_end_}, q_, y_);
  q_mid_ = 0.5 * (state.q + q_);
  v_ = (q_ - state.q) / dt_;
  model_.forces(point(state, u), forces_);
  evaluated_ = true;
}

void Stepper::project_bracket() {
  if constexpr (has(Mutation::null_space_at_end)) manifold_.update(x_, q_, *frame_k_);
  manifold_.project(has(Mutation::null_space_at_end) ? *frame_k_ : *frame_n_, bracket_, r_);
  r_ += share_of_an_end * dt_ * forces_.on_rates;
}

double Stepper::residual_of(const State& state) {
  bracket_ = state.p + 0.5 * dt_ * forces_.force - forces_.momentum;
  if (forces_.begin.size() > 0) bracket_ += forces_.begin;
  const double terms =
      std::max({state.p.lpNorm<Eigen::Infinity>(), 0.5 * dt_ * forces_.force.lpNorm<Eigen::Infinity>(),
                0.5 * dt_ * forces_.on_rates.lpNorm<Eigen::Infinity>(), forces_.momentum.lpNorm<Eigen::Infinity>()});
  const Eigen::MatrixXd& Z = manifold_.loop_basis(*frame_n_);
  lambda_.noalias() = Z * mu_;
  manifold_.add_constraint_forces(has(Mutation::constraints_in_middle) ? q_mid_ : state.q, -1.0, lambda_, bracket_);
  parts_.gather(bracket_);
  project_bracket();
  manifold_.constraints(q_, gaps_);
  g_.noalias() = Z.transpose() * gaps_;
  parts_.keep_free(bracket_);
  const double largest = std::max(r_.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>(), parts_.largest_row(bracket_));
  return terms > 0.0 ? largest / terms : 0.0;
}

void Stepper::move() {
  evaluated_ = false;
  manifold_.retract(x_before_, dw_, x_);
  manifold_.configuration(x_, q_);
  mu_ = mu_before_ + dmu_;
  if (parts_.empty()) return;
  parts_.copy_slices(q_before_, q_);
  parts_.add_slices(1.0, dq_, q_);
  y_ = y_before_ + dy_;
}

void Stepper::scale_increment(double factor) {
  dw_ *= factor;
  dmu_ *= factor;
  if (parts_.empty()) return;
  dq_ *= factor;
  dy_ *= factor;
}

void Stepper::apply_increment(const State& state, StepReport& report) {
  x_before_ = x_;
  mu_before_ = mu_;
  if (!parts_.empty()) {
    q_before_ = q_;
    y_before_ = y_;
  }
  for (halvings_ = 0;; ++halvings_) {
    move();
    q_mid_ = 0.5 * (state.q + q_);
    report.sentence = model_.inadmissible(q_mid_);
    if (report.sentence.empty()) report.sentence = model_.inadmissible(q_);
    if (report.sentence.empty() || halvings_ == max_halvings) return;
    scale_increment(0.5);
  }
}

bool Stepper::retreat(StepReport& report) {
  if (++halvings_ > max_halvings) {
    report.sentence = model_.inadmissible_anywhere(q_mid_);
    if (report.sentence.empty()) report.sentence = model_.inadmissible_anywhere(q_);
    if (report.sentence.empty()) report.sentence = "an element of a solid collapses";
    return false;
  }
  if (inverted_.empty()) inverted_ = model_.inadmissible_anywhere(q_mid_);
  if (inverted_.empty()) inverted_ = model_.inadmissible_anywhere(q_);
  scale_increment(0.5);
  move();
  return true;
}

bool Stepper::factorise_parts(const model::IntervalPoint& at, StepReport& report) {
  wants_factor_ = false;
  ++report.factorisations;
  factor_.valid = true;
  factor_.first = at.first;
  factor_.q0 = at.q0;
  factor_.q1 = at.q1;
  factor_.y = y_;
  if (parts_.factorise(at)) return true;
  report.sentence = "the matrix of a solid is singular";
  return false;
}

Increment Stepper::solve(const State& state, std::span<const double> u, StepReport& report) {
  constexpr Increment failed{.size = std::numeric_limits<double>::quiet_NaN()};
  const model::IntervalPoint at = point(state, u);
  if (manifold_.n_v() > 0) {
    manifold_.update(x_, q_, *frame_k_);
    model_.tangent(at, model::TangentWeights::step(dt_), K_);
    model_.rate_tangent(at, model::TangentWeights::step(dt_), diagonal_);
  }
  if (!parts_.empty()) {
    if ((wants_factor_ || !parts_.factorised()) && !factorise_parts(at, report)) return failed;
    parts_.turn(q_);
    if (exact_) parts_.linearise(at, accuracy_);
    parts_.eliminate(bracket_, forces_.stage, K_);
    project_bracket();
  }
  if (manifold_.n_v() > 0) {
    if (parts_.empty()) ++report.factorisations;
    if (!solver_->factorise(*frame_n_, *frame_k_, K_, diagonal_)) {
      report.sentence = "the Newton matrix is singular";
      return failed;
    }
    g_ = -g_;
    solver_->solve(r_, g_, dw_, dmu_);
  }
  Increment increment;
  increment.size = dw_.size() > 0 ? dw_.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>() : 0.0;
  increment.length = increment.size;
  if (!parts_.empty()) {
    dq_.setZero();
    manifold_.lift(*frame_k_, dw_, dq_);
    parts_.complete(dq_, dy_);
    const model::IncrementSize of_parts = parts_.size_of(dq_, dy_);
    increment.length = std::max(increment.length, of_parts.positions);
    increment.stage = of_parts.stage;
    if (!(of_parts.largest() <= increment.size)) increment.size = of_parts.largest();
  }
  if (!std::isfinite(increment.size)) report.sentence = "the Newton increment is not finite";
  return increment;
}

bool Stepper::newton(const State& state, std::span<const double> u, bool keep_factors, StepReport& report) {
  Contraction contraction;
  halvings_ = max_halvings;
  exact_ = !keep_factors || state.exact_steps > 0;
  for (int iteration = 1; iteration <= options_.max_iterations; ++iteration) {
    evaluate(state, u);
    while (!(forces_.margin > 0.0)) {
      if (!retreat(report)) return false;
      evaluate(state, u);
    }
    if (contraction.is_small(options_.tolerance) && forces_.violation <= violation_round_off) return true;
    report.residual = residual_of(state);
    ++report.iterations;
    const int factorisations = report.factorisations;
    wants_factor_ |= !keep_factors;
    accuracy_ = iteration == 1 ? coarsest_accuracy : std::clamp(contraction.size(), finest_accuracy, coarsest_accuracy);
    const Increment increment = solve(state, u, report);
    if (!std::isfinite(increment.size)) return false;
    contraction.take(increment, report.factorisations > factorisations, report.residual);
    if (!parts_.empty() && contraction.is_slow(options_.tolerance) && !contraction.stagnates()) {
      // What a new factor does not mend is not in its matrix.
      const bool use_exact = !exact_ && contraction.judges_new_factor();
      const bool grows = contraction.grows();
      exact_ |= use_exact;
      wants_factor_ = !use_exact;
      if (use_exact) contraction.count_anew();
      if (use_exact && grows) {
        contraction.drop_last();
        continue;
      }
      if (grows && !exact_) {
        report.sentence = "the increments grow";
        return false;
      }
    }
    if (increment.length > longest_increment) scale_increment(longest_increment / increment.length);
    apply_increment(state, report);
    if (!report.sentence.empty()) return false;
    if (contraction.is_small(options_.tolerance) && forces_.violation <= violation_goal) return true;
    if (contraction.stagnates()) return true;
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

bool Stepper::attempt(const State& state, std::span<const double> u, Attempt how, StepReport& report) {
  report.sentence.clear();
  inverted_.clear();
  start_at(state, how.extrapolate, u);
  if (how.extrapolate && !model_.inadmissible(q_).empty()) return false;
  return newton(state, u, how.keep_factors, report);
}

void Stepper::blame(StepReport& report) const {
  std::string why = model_.inadmissible(q_mid_);
  if (why.empty()) why = model_.inadmissible(q_);
  report.status = why.empty() ? Status::no_convergence : Status::muscle_collapse;
  if (!why.empty() || parts_.empty()) return;
  why = model_.inadmissible_anywhere(q_mid_);
  if (why.empty()) why = model_.inadmissible_anywhere(q_);
  // A collapse may also leave iterations to and fro at its brink.
  if (why.empty() && !inverted_.empty()) why = inverted_ + ", to which the iterations of the step come back";
  if (why.empty()) return;
  report.status = Status::inverted_element;
  report.sentence = why;
}

StepReport Stepper::advance(State& state, std::span<const double> u) {
  StepReport report;
  manifold_.update(state.x, state.q, *frame_n_);
  if (!choose_loop_rows(report)) return report;
  restore_factors(state, u);
  wants_factor_ |= state.factor_use.renews;
  bool converged = attempt(state, u, {.extrapolate = true, .keep_factors = true}, report);
  if (!converged && !parts_.empty()) {
    wants_factor_ = true;
    converged = attempt(state, u, {.extrapolate = true, .keep_factors = true}, report) ||
                attempt(state, u, {.extrapolate = true, .keep_factors = false}, report);
  }
  // The predictor may be far off after a sudden change of the controls: start once more from the last node.
  if (!converged) converged = attempt(state, u, {.extrapolate = false, .keep_factors = false}, report);
  if (!converged) {
    wants_factor_ = true;
    blame(report);
    return report;
  }
  finish(state, u, report);
  return report;
}

void Stepper::carry_residual() {
  if (!parts_.empty()) rest_ = bracket_;
  if (manifold_.n_v() > 0) {
    g_.setZero();
    solver_->solve(r_, g_, dw_, dmu_);
    v_.setZero();
    manifold_.lift(*frame_k_, dw_, v_);
    K_.multiply(v_, bracket_);
    r_ = diagonal_.cwiseProduct(dw_);
    manifold_.add_forces_on_rates(*frame_k_, 1.0, r_, bracket_);
  } else {
    bracket_.setZero();
  }
  parts_.copy_slices(rest_, bracket_);
}

void Stepper::finish(State& state, std::span<const double> u, StepReport& report) {
  if (!evaluated_) evaluate(state, u);
  const model::Turn turn = manifold_.largest_turn(state.q, q_);
  report.rotation = turn.angle;
  report.turning = turn.node;
  if (report.rotation > options_.refuse_rotation) {
    report.status = Status::step_too_large;
    report.sentence = base::format("{} turns by {:.3g} rad in one step (limit {:g}): use a smaller step",
                                   model_.body_at(turn.node), turn.angle, options_.refuse_rotation);
    return;
  }
  if (manifold_.n_c() > 0) {
    manifold_.update(x_, q_, *frame_k_);
    if (manifold_.loops_cross(*frame_n_, *frame_k_)) report.loop_regularity = 0.0;
  }
  report.residual = residual_of(state);
  const double weight = state.step == 0 ? 0.5 * dt_ : dt_;
  constraint_force_ = -(state.p + 0.5 * dt_ * forces_.force - forces_.momentum) / weight;
  if (forces_.begin.size() > 0) constraint_force_ -= forces_.begin / weight;
  manifold_.add_forces_on_rates(*frame_n_, -share_of_an_end * dt_ / weight, forces_.on_rates, constraint_force_);
  parts_.gather(constraint_force_);
  report.violation = forces_.violation;
  report.work = model_.work(point(state, u));
  manifold_.difference(state.x, x_, state.increment);
  state.multipliers = lambda_ / weight;
  carry_residual();
  state.p = forces_.momentum + 0.5 * dt_ * forces_.force + bracket_;
  if (!forces_.on_rates.isZero(0.0)) {
    manifold_.update(x_, q_, *frame_k_);
    manifold_.add_forces_on_rates(*frame_k_, share_of_an_end * dt_, forces_.on_rates, state.p);
  }
  if (forces_.end.size() > 0) state.p += forces_.end;
  if (!parts_.empty()) {
    state.advance = q_ - state.q;
    if constexpr (has(Mutation::potentials_at_nodes)) y_ = 2.0 * y_ - state.y;
    state.y = y_;
    if (report.factorisations > 0 || !state.factor.valid) state.factor = factor_;
    state.factor_use.book(report.iterations, report.factorisations > 0);
    // Tried without again now and then: the exact derivative costs many products.
    state.exact_steps = exact_ && state.exact_steps == 0 ? exact_for_steps : std::max(0, state.exact_steps - 1);
  }
  state.x = x_;
  state.q = q_;
  ++state.step;
  state.t = static_cast<double>(state.step) * dt_;
}

}  // namespace muldi::variational
