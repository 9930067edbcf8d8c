#include "support/tied_referee.hpp"

#include "math/derivative_check.hpp"

namespace muldi::test {

using Eigen::Vector3d;
using Eigen::VectorXd;

TiedReferee::TiedReferee(const TiedSystem& system, double dt) : ties_(system.solids.at(0).ties), dt_(dt) {
  TiedSystem loose = system;
  host_ = loose.solids[0].hosts.at(0).first;
  loose.solids[0].ties.clear();
  loose.solids[0].hosts.clear();
  model_ = make_model(loose);
  const fem::Solid& solid = solid_of(*model_, 0);
  for (int n = 0; n < solid.elements().n_nodes(); ++n) {
    for (int i = 0; i < 3; ++i) {
      if (solid.unknowns().is_free(n, i))
        free_q_.push_back(solid.q_slice().first + 3 * static_cast<Eigen::Index>(n) + i);
    }
    if (solid.n_potentials() > 0 && solid.unknowns().is_free(n, fem::potential_bit)) {
      free_y_.push_back(solid.y_slice().first + n);
    }
  }
  for (Eigen::Index e = 0; e < solid.n_pressures(); ++e) {
    free_y_.push_back(solid.y_slice().first + solid.n_potentials() + e);
  }
  frame_ = model_->manifold->make_frame();
  for (VectorXd* v : {&at_.force, &at_.momentum, &at_.begin, &at_.end, &q_}) *v = VectorXd::Zero(model_->n_q());
  at_.stage = y_ = VectorXd::Zero(model_->n_y());
  at_.on_rates = VectorXd::Zero(model_->manifold->n_v());
  x_ = model_->manifold->reference();
  forces_.resize(3, static_cast<Eigen::Index>(ties_.size()));
}

/// z: rates of the joints, free positions, free stage unknowns, multipliers.
void TiedReferee::spread(const variational::State& state, const std::vector<double>& u, const VectorXd& z) {
  const Eigen::Index n_v = model_->manifold->n_v();
  model_->manifold->retract(state.x, z.head(n_v), x_);
  q_ = state.q;
  model_->manifold->configuration(x_, q_);
  Eigen::Index k = n_v;
  for (const Eigen::Index i : free_q_) q_[i] = z[k++];
  for (const Eigen::Index i : free_y_) y_[i] = z[k++];
  lambda_ = z.tail(z.size() - k);
  model_->substructures[0]->place({.u = u, .u_end = u}, q_, y_);
}

VectorXd TiedReferee::residual(const variational::State& state, const std::vector<double>& u, const VectorXd& z) {
  spread(state, u, z);
  const VectorXd middle = 0.5 * (state.q + q_);
  const VectorXd v = (q_ - state.q) / dt_;
  const auto size = static_cast<std::size_t>(x_.size());
  model_->forces({.q0 = state.q,
                  .q1 = q_,
                  .q = middle,
                  .v = v,
                  .u = u,
                  .dt = dt_,
                  .x0 = {state.x.data(), size},
                  .x1 = {x_.data(), size},
                  .y = &y_,
                  .first = state.step == 0},
                 at_);
  momentum_ = at_.momentum + 0.5 * dt_ * at_.force + at_.end;
  VectorXd bracket = state.p + 0.5 * dt_ * at_.force - at_.momentum + at_.begin;
  VectorXd gap(lambda_.size());
  const Eigen::Index first = model_->substructures[0]->q_slice().first;
  for (std::size_t t = 0; t < ties_.size(); ++t) {
    const Vector3d& xi = ties_[t].xi;
    const Vector3d force = lambda_.segment<3>(3 * static_cast<Eigen::Index>(t));
    const Eigen::Index node = first + 3 * static_cast<Eigen::Index>(ties_[t].node);
    bracket.segment<3>(node) += force;
    bracket.segment<3>(host_) -= force;
    Vector3d at = q_.segment<3>(host_);
    for (int i = 0; i < 3; ++i) {
      bracket.segment<3>(host_ + 3 + 3 * i) -= xi[i] * force;
      at += xi[i] * q_.segment<3>(host_ + 3 + 3 * i);
    }
    gap.segment<3>(3 * static_cast<Eigen::Index>(t)) = q_.segment<3>(node) - at;
  }
  VectorXd r(model_->manifold->n_v());
  model_->manifold->project(*frame_, bracket, r);
  VectorXd all(z.size());
  all.head(r.size()) = r;
  Eigen::Index k = r.size();
  for (const Eigen::Index i : free_q_) all[k++] = bracket[i];
  for (const Eigen::Index i : free_y_) all[k++] = at_.stage[i];
  all.tail(gap.size()) = gap;
  return all;
}

void TiedReferee::advance(variational::State& state, const std::vector<double>& u) {
  const model::Manifold& manifold = *model_->manifold;
  manifold.update(state.x, state.q, *frame_);
  manifold.choose_loop_rows(*frame_);
  const auto n_rows = static_cast<Eigen::Index>(free_q_.size() + free_y_.size() + 3 * ties_.size());
  VectorXd z = VectorXd::Zero(manifold.n_v() + n_rows);
  Eigen::Index k = manifold.n_v();
  for (const Eigen::Index i : free_q_) z[k++] = state.q[i];
  for (const Eigen::Index i : free_y_) z[k++] = state.y[i];
  const auto of = [&](const VectorXd& at) { return residual(state, u, at); };
  for (int iteration = 0; iteration < 8; ++iteration) {
    const Eigen::MatrixXd K = math::difference_jacobian(of, z, VectorXd::Constant(z.size(), 1e-3));
    const VectorXd step = K.fullPivLu().solve(residual(state, u, z));
    z -= step;
    if (step.lpNorm<Eigen::Infinity>() < 1e-13) break;
  }
  residual(state, u, z);
  const double weight = state.step == 0 ? 0.5 * dt_ : dt_;
  for (Eigen::Index t = 0; t < forces_.cols(); ++t) forces_.col(t) = lambda_.segment<3>(3 * t) / weight;
  state.x = x_;
  state.q = q_;
  state.y = y_;
  state.p = momentum_;
  ++state.step;
}

}  // namespace muldi::test
