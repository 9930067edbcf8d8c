/// Where the iterations of a step start.
#include <algorithm>

#include "variational/control_rates.hpp"
#include "variational/stepper.hpp"

namespace muldi::variational {

void Stepper::start_at(const State& state, bool extrapolate, std::span<const double> u) {
  if (extrapolate) {
    manifold_.retract(state.x, state.increment, x_);
    mu_.noalias() =
        (state.step == 0 ? 0.5 * dt_ : dt_) * manifold_.loop_basis(*frame_n_).transpose() * state.multipliers;
  } else {
    x_ = state.x;
    mu_.setZero();
  }
  manifold_.configuration(x_, q_);
  if (parts_.empty()) return;
  parts_.copy_slices(state.q, q_);
  if (extrapolate) parts_.add_slices(1.0, state.advance, q_);
  y_ = state.y;
  if (parts_.moves()) model_.evaluate_controls(state.t + (1.0 - before_end) * dt_, u_end_);
  parts_.place({.u = u, .u_end = u_end_}, q_, y_);
  // Where controls change the potentials jump with them: they are settled before the first matrix is made.
  if (state.step > 0) model_.evaluate_controls(state.t - 0.5 * dt_, u_last_);
  if (state.step > 0 && std::equal(u.begin(), u.end(), u_last_.begin())) return;
  q_mid_ = 0.5 * (state.q + q_);
  v_ = (q_ - state.q) / dt_;
  parts_.settle_stage(point(state, u), y_);
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
