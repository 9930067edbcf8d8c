#include "pipeline/trajectory_rows.hpp"

#include <algorithm>

namespace muldi::pipeline {
namespace {

std::span<const double> span_of(const Eigen::VectorXd& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

}  // namespace

TrajectoryRows::TrajectoryRows(const build::BuiltModel& built, const control::Trajectory& trajectory)
    : model_(*built.model),
      manifold_(*built.manifold),
      trajectory_(trajectory),
      n_steps_(static_cast<long>(trajectory.u.size())),
      nodes_(model_, built.linear),
      supply_(model_),
      frame_(manifold_.make_frame()) {
  for (Eigen::VectorXd* in_q :
       {&q1_, &q_mid_, &v_, &constraint_force_, &forces_.force, &forces_.momentum, &state_.q, &state_.p}) {
    *in_q = Eigen::VectorXd::Zero(model_.n_q());
  }
  if (model_.acts_at_ends()) forces_.begin = forces_.end = q1_;
  forces_.on_rates = projected_ = Eigen::VectorXd::Zero(manifold_.n_v());
  multipliers_ = Eigen::VectorXd::Zero(manifold_.n_loop_rows());
  state_.x = trajectory.x.front();
  manifold_.configuration(state_.x, state_.q);
  state_.multipliers = multipliers_;
  state_.increment = projected_;
}

const std::vector<double>& TrajectoryRows::controls(long n) const {
  return trajectory_.u[static_cast<std::size_t>(std::clamp(n, 0L, n_steps_ - 1))];
}

void TrajectoryRows::evaluate(long n) {
  const Eigen::VectorXd& x1 = trajectory_.x[static_cast<std::size_t>(n) + 1];
  manifold_.configuration(x1, q1_);
  q_mid_ = 0.5 * (state_.q + q1_);
  v_ = (q1_ - state_.q) / trajectory_.step;
  const model::IntervalPoint at{.q0 = state_.q,
                                .q1 = q1_,
                                .q = q_mid_,
                                .v = v_,
                                .u = controls(n),
                                .dt = trajectory_.step,
                                .x0 = span_of(state_.x),
                                .x1 = span_of(x1),
                                .first = n == 0};
  for (Eigen::VectorXd* force : {&forces_.force, &forces_.momentum, &forces_.begin, &forces_.end, &forces_.on_rates}) {
    force->setZero();
  }
  model_.forces(at, forces_);
  work_ = model_.work(at);
}

void TrajectoryRows::balance(long n) {
  const double half = 0.5 * trajectory_.step;
  const double weight = n == 0 ? half : trajectory_.step;
  constraint_force_ = -(state_.p + half * forces_.force - forces_.momentum) / weight;
  if (forces_.begin.size() > 0) constraint_force_ -= forces_.begin / weight;
  manifold_.update(state_.x, state_.q, *frame_);
  manifold_.add_forces_on_rates(*frame_, -half / weight, forces_.on_rates, constraint_force_);
  multipliers_.setZero();
  if (!trajectory_.multipliers.empty()) multipliers_ = trajectory_.multipliers[static_cast<std::size_t>(n)] / weight;
  // What the constraints cannot take up is missing in the equations of motion.
  q_mid_ = constraint_force_;
  manifold_.add_constraint_forces(state_.q, 1.0, multipliers_, q_mid_);
  manifold_.project(*frame_, q_mid_, projected_);
  const double left = projected_.cwiseQuotient(manifold_.rate_scale()).lpNorm<Eigen::Infinity>();
  report_.residual = largest_impulse_ > 0.0 ? weight * left / largest_impulse_ : 0.0;
}

void TrajectoryRows::advance(long n) {
  const double half = 0.5 * trajectory_.step;
  ledger_.dissipated += work_.dissipated;
  ledger_.external += work_.external;
  state_.x = trajectory_.x[static_cast<std::size_t>(n) + 1];
  state_.q = q1_;
  state_.p = forces_.momentum + half * forces_.force;
  manifold_.update(state_.x, state_.q, *frame_);
  manifold_.add_forces_on_rates(*frame_, half, forces_.on_rates, state_.p);
  if (forces_.end.size() > 0) state_.p += forces_.end;
  state_.step = n + 1;
  state_.t = static_cast<double>(n + 1) * trajectory_.step;
}

void TrajectoryRows::record(NodeRows& rows, long n) {
  rows.write({.step = n,
              .t = state_.t,
              .state = state_,
              .values = values_,
              .ledger = ledger_,
              .constraint_force = constraint_force_,
              .multipliers = multipliers_,
              .y_after = stage_,
              .u = controls(n - 1),
              .report = report_,
              .last = n == n_steps_});
}

void TrajectoryRows::book_supply(long n) {
  const auto view = [&](long interval) {
    return model::NodeView{.serial = -2 - 2 * n - (interval - n),
                           .t = state_.t,
                           .x = state_.x,
                           .rate = values_.rate,
                           .q = state_.q,
                           .v = values_.v,
                           .constraint_force = constraint_force_,
                           .multipliers = multipliers_,
                           .y = stage_,
                           .u = controls(interval)};
  };
  if (n == 0) return supply_.open(view(0), ledger_.supply);
  supply_.stand(view(n - 1));
  supply_.change(view(n), ledger_.supply);
}

void TrajectoryRows::find_largest_impulse() {
  const Eigen::VectorXd first = state_.q;
  for (long n = 0; n < n_steps_; ++n) {
    state_.x = trajectory_.x[static_cast<std::size_t>(n)];
    manifold_.configuration(state_.x, state_.q);
    evaluate(n);
    largest_impulse_ = std::max({largest_impulse_, 0.5 * trajectory_.step * forces_.force.lpNorm<Eigen::Infinity>(),
                                 forces_.momentum.lpNorm<Eigen::Infinity>()});
  }
  state_.x = trajectory_.x.front();
  state_.q = first;
}

void TrajectoryRows::begin() {
  const double half = 0.5 * trajectory_.step;
  evaluate(0);
  // The momentum before the first interval: what its own terms leave over for the node.
  state_.p = forces_.momentum - half * forces_.force;
  if (forces_.begin.size() > 0) state_.p -= forces_.begin;
  manifold_.update(state_.x, state_.q, *frame_);
  manifold_.add_forces_on_rates(*frame_, -half, forces_.on_rates, state_.p);
  nodes_.evaluate(state_, controls(0), controls(0), values_);
  state_.p = values_.momentum;
  ledger_.initial_total = values_.total.kinetic + values_.total.potential();
}

const Eigen::VectorXd& TrajectoryRows::initial_rates() {
  begin();
  return values_.rate;
}

void TrajectoryRows::write(NodeRows& rows) {
  find_largest_impulse();
  begin();
  if (supply_.is_kept()) book_supply(0);
  for (long n = 0; n < n_steps_; ++n) {
    double jump = 0.0;
    if (n > 0) {
      evaluate(n);
      nodes_.evaluate(state_, controls(n - 1), controls(n), values_);
      jump = nodes_.electric(state_, controls(n)) - nodes_.electric(state_, controls(n - 1));
    }
    balance(n);
    record(rows, n);
    ledger_.source += jump;
    if (supply_.is_kept() && n > 0) book_supply(n);
    advance(n);
  }
  nodes_.evaluate(state_, controls(n_steps_), controls(n_steps_), values_);
  constraint_force_ = (values_.momentum - state_.p) / (0.5 * trajectory_.step);
  multipliers_ = nodes_.loop_impulse() / (0.5 * trajectory_.step);
  report_.residual = 0.0;
  record(rows, n_steps_);
}

}  // namespace muldi::pipeline
