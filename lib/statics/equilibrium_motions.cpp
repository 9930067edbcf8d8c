/// Motions of an equilibrium: the plain Newton step, the response to the load, and their measures.
#include <algorithm>

#include "statics/equilibrium.hpp"

namespace muldi::statics {

Eigen::VectorXd EquilibriumSolver::load_rate(std::span<const double> u, std::span<const double> du) {
  const Eigen::Index n_v = manifold_.n_v();
  const model::IntervalPoint at{.q0 = q_, .q1 = q_, .q = q_, .v = zero_, .u = u, .y = &y_};
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(model_.n_q());
  Eigen::VectorXd on_rates = Eigen::VectorXd::Zero(n_v);
  Eigen::VectorXd one = rows;
  Eigen::VectorXd one_on_rates = on_rates;
  for (std::size_t c = 0; c < du.size(); ++c) {
    if (du[c] == 0.0) continue;
    one.setZero();
    one_on_rates.setZero();
    for (const auto& term : model_.terms) {
      term->add_control_force(at, static_cast<int>(c), one);
      term->add_control_force_on_rates(at, static_cast<int>(c), one_on_rates);
    }
    rows += du[c] * one;
    on_rates += du[c] * one_on_rates;
  }
  if (!parts_.empty()) {
    linearised_.u.clear();  // the parts answer to other right sides from here on
    Eigen::VectorXd h = Eigen::VectorXd::Zero(model_.n_y());
    parts_.add_load_rate(at, du, rows, h);
    parts_.gather(rows);
    parts_.keep_free(rows);
    parts_.eliminate(rows, h, K_);
  }
  Eigen::VectorXd projected(n_v);
  manifold_.project(*frame_, rows, projected);
  return projected + on_rates;
}

void EquilibriumSolver::motions(std::span<const double> u, std::span<const double> du, StaticMotion& newton,
                                StaticMotion& load) {
  const Eigen::Index n_v = manifold_.n_v();
  const Eigen::Index n_c = manifold_.n_c();
  Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n_v + n_c, n_v + n_c);
  kkt.topLeftCorner(n_v, n_v) = scale_.asDiagonal() * A_ * scale_.asDiagonal();
  kkt.topRightCorner(n_v, n_c) = (B_ * scale_.asDiagonal()).transpose();
  kkt.bottomLeftCorner(n_c, n_v) = B_ * scale_.asDiagonal();
  const Eigen::PartialPivLU<Eigen::MatrixXd> factor(kkt);
  const auto solve = [&](const Eigen::VectorXd& forces, const Eigen::VectorXd& gaps, StaticMotion& out) {
    Eigen::VectorXd rhs(n_v + n_c);
    rhs << scale_.cwiseProduct(forces), -gaps;
    const Eigen::VectorXd solution = n_v > 0 ? Eigen::VectorXd(factor.solve(rhs)) : rhs;
    out.w = scale_.cwiseProduct(solution.head(n_v));
    out.multipliers = loop_basis() * solution.tail(n_c);
    if (parts_.empty()) return;
    out.q.setZero(model_.n_q());
    out.y.setZero(model_.n_y());
    manifold_.lift(*frame_, out.w, out.q);
    parts_.complete(out.q, out.y);
  };
  solve(r_, g_, newton);

  solve(load_rate(u, du), Eigen::VectorXd::Zero(n_c), load);
}

double EquilibriumSolver::product(const StaticMotion& a, const StaticMotion& b) const {
  const double of_rates = a.w.cwiseQuotient(scale_).dot(b.w.cwiseQuotient(scale_));
  return parts_.empty() ? of_rates : of_rates + parts_.product(a.q, b.q);
}

double EquilibriumSolver::size_of(const StaticMotion& motion) const {
  const double size = motion.w.size() > 0 ? motion.w.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>() : 0.0;
  if (parts_.empty()) return size;
  const double of_parts = parts_.size_of(motion.q, motion.y).largest();
  return of_parts <= size ? size : of_parts;
}

void EquilibriumSolver::move(const StaticState& start, double factor, const StaticMotion& along,
                             StaticState& trial) const {
  manifold_.retract(start.x, factor * along.w, trial.x);
  trial.multipliers = start.multipliers + factor * along.multipliers;
  if (parts_.empty()) return;
  trial.q = start.q;
  parts_.add_slices(factor, along.q, trial.q);
  trial.y = start.y + factor * along.y;
}

void EquilibriumSolver::swing(const StaticState& start, double factor, const StaticMotion& along, StaticState& trial) {
  move(start, factor, along, trial);
  if (parts_.empty()) return;
  // Where the bodies go beyond the first order.
  manifold_.configuration(start.x, before_);
  parts_.copy_slices(start.q, before_);
  manifold_.configuration(trial.x, excess_);
  excess_ -= before_ + factor * along.q;
  parts_.carry(before_, excess_, trial.q);
}

StaticMotion EquilibriumSolver::difference(const StaticState& a, const StaticState& b) const {
  StaticMotion motion{.w = Eigen::VectorXd::Zero(manifold_.n_v()), .multipliers = b.multipliers - a.multipliers};
  manifold_.difference(a.x, b.x, motion.w);
  if (parts_.empty()) return motion;
  motion.q = b.q - a.q;
  motion.y = b.y - a.y;
  return motion;
}

std::string EquilibriumSolver::why_inadmissible(const StaticState& state) {
  linearised_.u.clear();
  manifold_.configuration(state.x, q_);
  return model_.inadmissible(q_);
}

void EquilibriumSolver::settle(StaticState& state) {
  state.multipliers = loop_basis() * (loop_basis().transpose() * state.multipliers);
  if (parts_.empty()) return;
  state.q = q_;
  state.y = y_;
  if (!linearised_.u.empty()) linearised_.state = state;
}

}  // namespace muldi::statics
