#include "pipeline/led_solids.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace muldi::pipeline {
namespace {

constexpr double longest_step = 0.02;  // of the bodies, dimensionless: 1 is a radian or the size of the scene
constexpr double shortest_step = 1e-5;
constexpr double longest_increment = 0.3;  // of the solids in a Newton iteration
constexpr int max_iterations = 20;

}  // namespace

LedSolids::LedSolids(const build::BuiltModel& built, double tolerance)
    : model_(*built.model),
      manifold_(*built.manifold),
      u_(built.model->controls.size(), 0.0),
      tolerance_(tolerance),
      K_(*built.model->pattern) {
  any_ = std::any_of(built.solids.begin(), built.solids.end(),
                     [](const fem::Solid* solid) { return !solid->data().ties.empty(); });
  if (!any_) return;
  parts_ = std::make_unique<model::SubstructureSet>(model_, model::Linearisation::rest, "auto");
  zero_q_ = dq_ = Eigen::VectorXd::Zero(model_.n_q());
  dy_ = Eigen::VectorXd::Zero(model_.n_y());
  forces_ = {.force = zero_q_, .momentum = zero_q_, .begin = zero_q_, .end = zero_q_, .stage = dy_};
}

bool LedSolids::linearise(const statics::StaticState& state) {
  const model::IntervalPoint at{.q0 = state.q, .q1 = state.q, .q = state.q, .v = zero_q_, .u = u_, .y = &state.y};
  forces_.margin = std::numeric_limits<double>::infinity();
  forces_.force.setZero();
  forces_.momentum.setZero();
  forces_.stage.setZero();
  for (const auto& part : model_.substructures) part->add_forces(at, forces_);
  if (!(forces_.margin > 0.0)) return false;
  parts_->gather(forces_.force);
  parts_->keep_free(forces_.force);
  return parts_->factorise(at);
}

void LedSolids::answer() {
  parts_->eliminate(forces_.force, forces_.stage, K_);
  parts_->complete(dq_, dy_);
}

void LedSolids::add_answer(statics::StaticState& state) const {
  parts_->add_slices(1.0, dq_, state.q);
  state.y += dy_;
  parts_->place({.u = u_, .u_end = u_}, state.q, state.y);
}

bool LedSolids::settle(statics::StaticState& state) {
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    if (!linearise(state)) return false;
    dq_.setZero();
    answer();
    const double size = parts_->size_of(dq_, dy_).largest();
    if (!std::isfinite(size)) return false;
    if (size > longest_increment) {
      dq_ *= longest_increment / size;
      dy_ *= longest_increment / size;
    }
    add_answer(state);
    if (size <= tolerance_) return true;
  }
  return false;
}

bool LedSolids::lead_to(const Eigen::VectorXd& x, statics::StaticState& state) {
  const Eigen::VectorXd x0 = state.x;
  Eigen::VectorXd way(manifold_.n_v());
  manifold_.difference(x0, x, way);
  const double length = way.size() > 0 ? way.cwiseQuotient(manifold_.rate_scale()).lpNorm<Eigen::Infinity>() : 0.0;
  const double first = 1.0 / std::max(1.0, std::ceil(length / longest_step));
  statics::StaticState at = state;
  if (!settle(at)) return false;
  double done = 0.0;
  double step = first;
  while (done < 1.0) {
    const double next = std::min(1.0, done + step);
    statics::StaticState trial = at;
    manifold_.retract(x0, next * way, trial.x);
    if (next == 1.0) trial.x = x;
    manifold_.configuration(trial.x, trial.q);
    bool good = linearise(at);
    if (good) {
      const Eigen::Index n = manifold_.n_q();
      dq_.setZero();
      dq_.head(n) = trial.q.head(n) - at.q.head(n);
      answer();
      add_answer(trial);
      good = settle(trial);
    }
    if (!good) {
      step *= 0.5;
      if (step * length < shortest_step) return false;
      continue;
    }
    at = std::move(trial);
    done = next;
    step = std::min(first, 2.0 * step);
  }
  state = std::move(at);
  return true;
}

void LedSolids::add_velocities(const statics::StaticState& state, Eigen::VectorXd& v) {
  if (!linearise(state)) return;
  // At rest the forces vanish; what is left of them is no velocity.
  forces_.force.setZero();
  forces_.stage.setZero();
  dq_.setZero();
  dq_.head(manifold_.n_q()) = v.head(manifold_.n_q());
  answer();
  parts_->add_slices(1.0, dq_, v);
}

}  // namespace muldi::pipeline
