/// Where the iterations of a step start.
#include <algorithm>

#include "variational/stepper.hpp"

namespace muldi::variational {
namespace {

/// Part of a step by which positions are prescribed before its end: where a held control jumps, its old value counts.
constexpr double before_end = 1e-9;

/// Part of the error of a repeated increment below which an extrapolated one is preferred.
constexpr double clearly_better = 0.5;

}  // namespace

void Stepper::start_at(const State& state, bool extrapolate, std::span<const double> u) {
  if (extrapolate) {
    if (state.trend.of_positions) {
      dw_ = 2.0 * state.increment - state.trend.increment;
      manifold_.retract(state.x, dw_, x_);
    } else {
      manifold_.retract(state.x, state.increment, x_);
    }
    mu_.noalias() =
        (state.step == 0 ? 0.5 * dt_ : dt_) * manifold_.loop_basis(*frame_n_).transpose() * state.multipliers;
  } else {
    x_ = state.x;
    mu_.setZero();
  }
  manifold_.configuration(x_, q_);
  if (parts_.empty()) return;
  parts_.copy_slices(state.q, q_);
  if (extrapolate) {
    parts_.add_slices(state.trend.of_positions ? 2.0 : 1.0, state.advance, q_);
    if (state.trend.of_positions) parts_.add_slices(-1.0, state.trend.advance, q_);
  }
  y_ = state.y;
  if (extrapolate && state.trend.of_stage) y_ += state.y - state.trend.y;
  if (parts_.moves()) model_.evaluate_controls(state.t + (1.0 - before_end) * dt_, u_end_);
  parts_.place({.u = u, .u_end = u_end_}, q_, y_);
  // Where controls change the potentials jump with them: they are settled before the first matrix is made.
  if (state.step > 0) model_.evaluate_controls(state.t - 0.5 * dt_, u_last_);
  if (state.step > 0 && std::equal(u.begin(), u.end(), u_last_.begin())) return;
  q_mid_ = 0.5 * (state.q + q_);
  v_ = (q_ - state.q) / dt_;
  parts_.settle_stage(point(state, u), y_);
}

/// A straight line is taken where it would have served the step that has just ended clearly better: not where controls
/// have jumped, nor in motions that the steps do not resolve.
void Stepper::follow_trend(State& state) {
  Trend& trend = state.trend;
  trend.of_positions = trend.of_stage = false;
  dq_ = q_ - state.q;
  if (state.step > 0 && trend.advance.size() == dq_.size()) {
    q_before_ = dq_ - state.advance;
    y_before_ = y_ - state.y;
    const model::IncrementSize repeated = parts_.size_of(q_before_, y_before_);
    q_before_ -= state.advance - trend.advance;
    y_before_ -= state.y - trend.y;
    const model::IncrementSize extrapolated = parts_.size_of(q_before_, y_before_);
    trend.of_positions = extrapolated.positions < clearly_better * repeated.positions;
    trend.of_stage = extrapolated.stage < clearly_better * repeated.stage;
  }
  trend.advance = state.advance;
  trend.y = state.y;
  state.advance = dq_;
  state.y = y_;
}

void Stepper::restore_factors(const State& state, std::span<const double> u) {
  if (parts_.empty() || parts_.factorised() || !state.factor.valid) return;
  factor_ = state.factor;
  y_ = factor_.y;
  q_mid_ = 0.5 * (factor_.q0 + factor_.q1);
  v_ = (factor_.q1 - factor_.q0) / dt_;
  const model::IntervalPoint at{
      .q0 = factor_.q0, .q1 = factor_.q1, .q = q_mid_, .v = v_, .u = u, .dt = dt_, .y = &y_, .first = factor_.first};
  wants_factor_ = !parts_.factorise(at);
}

}  // namespace muldi::variational
