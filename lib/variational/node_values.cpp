#include "variational/node_values.hpp"

namespace muldi::variational {

NodeEvaluator::NodeEvaluator(const model::Model& model, const std::string& linear, const std::string& substructures)
    : model_(model),
      solver_(model.manifold->make_solver(*model.pattern, linear)),
      parts_(model, model::Linearisation::velocity, substructures),
      frame_(model.manifold->make_frame()),
      M_(*model.pattern),
      r_(Eigen::VectorXd::Zero(model.manifold->n_v())),
      zero_c_(Eigen::VectorXd::Zero(model.manifold->n_c())),
      mu_(zero_c_),
      lambda_(Eigen::VectorXd::Zero(model.manifold->n_loop_rows())),
      zero_q_(Eigen::VectorXd::Zero(model.n_q())),
      bracket_(zero_q_),
      dy_(Eigen::VectorXd::Zero(model.n_y())),
      zero_y_(dy_),
      scratch_(model.parts().size()) {
  forces_.force = zero_q_;
  forces_.momentum = zero_q_;
  if (!parts_.empty()) {
    forces_.begin = forces_.end = zero_q_;
    forces_.stage = zero_y_;
  }
}

void NodeEvaluator::momentum_of(const Eigen::VectorXd& q, const Eigen::VectorXd& v, std::span<const double> u,
                                Eigen::VectorXd& p) {
  model_.forces({.q0 = q, .q1 = q, .q = q, .v = v, .u = u}, forces_);
  p = forces_.momentum;
}

bool NodeEvaluator::solve_velocities(const State& state, NodeValues& out) {
  const model::Manifold& manifold = *model_.manifold;
  bracket_ = state.p;
  if (!parts_.empty()) {
    if (!parts_.factorise({.q0 = state.q, .q1 = state.q, .q = state.q, .v = zero_q_, .u = {}})) return false;
    parts_.keep_free(bracket_);
    parts_.eliminate(bracket_, zero_y_, M_);
  }
  if (manifold.n_v() > 0) {
    if (!solver_->factorise(*frame_, *frame_, M_)) return false;
    manifold.project(*frame_, bracket_, r_);
    solver_->solve(r_, zero_c_, out.rate, mu_);
    lambda_.noalias() = manifold.loop_basis(*frame_) * mu_;
  }
  out.v.setZero();
  manifold.lift(*frame_, out.rate, out.v);
  parts_.complete(out.v, dy_);
  return true;
}

bool NodeEvaluator::evaluate(const State& state, std::span<const double> u_before, std::span<const double> u_after,
                             NodeValues& out) {
  const model::Manifold& manifold = *model_.manifold;
  out.rate.resize(manifold.n_v());
  out.v.resize(model_.n_q());
  out.momentum.resize(model_.n_q());
  out.parts.resize(scratch_.size());
  manifold.update(state.x, state.q, *frame_);
  manifold.choose_loop_rows(*frame_);
  model_.tangent({.q0 = state.q, .q1 = state.q, .q = state.q, .v = zero_q_, .u = u_before},
                 model::TangentWeights::mass(), M_);
  if (!solve_velocities(state, out)) return false;
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
