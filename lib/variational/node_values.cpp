#include "variational/node_values.hpp"

#include <cmath>

namespace muldi::variational {
namespace {

/// Passes with a factor that is not of this very node, at most.
constexpr int max_passes = 40;
/// Changes of the velocities, relative to the largest, that end the passes; beyond the second they end where they no
/// longer fall.
constexpr double velocity_goal = 1e-13;
constexpr double velocity_round_off = 1e-11;

}  // namespace

NodeEvaluator::NodeEvaluator(const model::Model& model, const std::string& linear, const std::string& substructures)
    : model_(model),
      solver_(model.manifold->make_solver(*model.pattern, linear)),
      parts_(model, model::Linearisation::velocity, substructures),
      frame_(model.manifold->make_frame()),
      M_(*model.pattern),
      MS_(*model.pattern),
      r_(Eigen::VectorXd::Zero(model.manifold->n_v())),
      dw_(r_),
      zero_c_(Eigen::VectorXd::Zero(model.manifold->n_c())),
      mu_(zero_c_),
      lambda_(Eigen::VectorXd::Zero(model.manifold->n_loop_rows())),
      zero_q_(Eigen::VectorXd::Zero(model.n_q())),
      bracket_(zero_q_),
      rest_(zero_q_),
      dv_(zero_q_),
      dy_(Eigen::VectorXd::Zero(model.n_y())),
      ddy_(dy_),
      h_(dy_),
      scratch_(model.parts().size()) {
  forces_.force = zero_q_;
  forces_.momentum = zero_q_;
  moves_ = parts_.moves();
  for (const auto& part : model.substructures) is_constrained_ |= part->add_velocity_rows(zero_q_, zero_q_, h_);
  if (!parts_.empty()) {
    forces_.begin = forces_.end = zero_q_;
    forces_.stage = dy_;
  }
}

void NodeEvaluator::momentum_of(const Eigen::VectorXd& q, const Eigen::VectorXd& v, std::span<const double> u,
                                Eigen::VectorXd& p) {
  model_.forces({.q0 = q, .q1 = q, .q = q, .v = v, .u = u}, forces_);
  p = forces_.momentum;
}

bool NodeEvaluator::factorise_parts(const State& state, bool anew) {
  // Where the stepper's factor was made, which is a part of the state, so that a restart takes the same way.
  const Eigen::VectorXd& where = state.factor.valid && !anew ? state.factor.q1 : state.q;
  if (!parts_.factorised() || factor_q_ != where) {
    if (!parts_.factorise({.q0 = where, .q1 = where, .q = where, .v = zero_q_, .u = {}})) return false;
    factor_q_ = where;
  }
  if (is_constrained_) parts_.turn(state.q);
  return true;
}

void NodeEvaluator::residual_of(const State& state, const NodeValues& at) {
  const model::Manifold& manifold = *model_.manifold;
  bracket_ = state.p;
  h_.setZero();
  if (!at.v.isZero(0.0)) {
    model_.forces({.q0 = state.q, .q1 = state.q, .q = state.q, .v = at.v, .u = {}}, forces_);
    bracket_ -= forces_.momentum;
    rest_.setZero();
    model_.each_part([&](const model::Substructure& part, std::size_t) {
      part.add_multiplier_impulse(state.q, dy_, rest_);
      part.add_velocity_rows(state.q, at.v, h_);
    });
    bracket_ -= rest_;
    manifold.add_constraint_forces(state.q, -1.0, lambda_, bracket_);
  }
  parts_.gather(bracket_);
  parts_.keep_free(bracket_);
}

double NodeEvaluator::improve(NodeValues& out) {
  const model::Manifold& manifold = *model_.manifold;
  dv_.setZero();
  if (manifold.n_v() > 0) {
    manifold.project(*frame_, bracket_, r_);
    solver_->solve(r_, zero_c_, dw_, mu_);
    lambda_.noalias() += manifold.loop_basis(*frame_) * mu_;
    manifold.lift(*frame_, dw_, dv_);
    out.rate += dw_;
  }
  parts_.complete(dv_, ddy_);
  out.v += dv_;
  dy_ += ddy_;
  const double size = out.v.lpNorm<Eigen::Infinity>();
  return size > 0.0 ? dv_.lpNorm<Eigen::Infinity>() / size : 0.0;
}

bool NodeEvaluator::solve_velocities(const State& state, std::span<const double> du, NodeValues& out) {
  for (const bool anew : {false, true}) {
    if (!parts_.empty() && !factorise_parts(state, anew)) return false;
    out.rate.setZero();
    out.v.setZero();
    if (moves_) {
      for (const auto& part : model_.substructures) part->follow(du, out.v);
    }
    dy_.setZero();
    lambda_.setZero();
    double previous = 0.0;
    for (int pass = 0; pass < max_passes; ++pass) {
      residual_of(state, out);
      if (pass > 0) {
        parts_.respond(bracket_, h_);
      } else {
        MS_ = M_;
        parts_.eliminate(bracket_, h_, MS_);
        if (model_.manifold->n_v() > 0 && !solver_->factorise(*frame_, *frame_, MS_)) return false;
      }
      const double change = improve(out);
      if (!is_constrained_ || change <= velocity_goal) return true;
      if (pass > 2 && change > 0.5 * previous && change < velocity_round_off) return true;
      if (!std::isfinite(change)) break;
      previous = change;
    }
    if (factor_q_ == state.q) break;
  }
  return std::isfinite(out.v.sum());
}

bool NodeEvaluator::evaluate(const State& state, std::span<const double> u_before, std::span<const double> u_after,
                             NodeValues& out, std::span<const double> du) {
  const model::Manifold& manifold = *model_.manifold;
  out.rate.resize(manifold.n_v());
  out.v.resize(model_.n_q());
  out.momentum.resize(model_.n_q());
  out.parts.resize(scratch_.size());
  manifold.update(state.x, state.q, *frame_);
  manifold.choose_loop_rows(*frame_);
  model_.tangent({.q0 = state.q, .q1 = state.q, .q = state.q, .v = zero_q_, .u = u_before},
                 model::TangentWeights::mass(), M_);
  if (!solve_velocities(state, du, out)) return false;
  momentum_of(state.q, out.v, u_before, out.momentum);
  model_.momentum_maps(state.q, out.momentum, out.linear_momentum, out.angular_momentum);
  const std::span<const double> x(state.x.data(), static_cast<std::size_t>(state.x.size()));
  model_.energies({.x = x, .q = state.q, .v = out.v, .u = u_before}, out.parts);
  out.total = {};
  for (const model::Energy& part : out.parts) out.total += part;
  out.electric_after = electric(state, u_after);
  return true;
}

double NodeEvaluator::electric(const State& state, std::span<const double> u) {
  const std::span<const double> x(state.x.data(), static_cast<std::size_t>(state.x.size()));
  model_.energies({.x = x, .q = state.q, .v = zero_q_, .u = u}, scratch_);
  double sum = 0.0;
  for (const model::Energy& part : scratch_) sum += part.electric;
  return sum;
}

}  // namespace muldi::variational
