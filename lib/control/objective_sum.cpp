#include "control/objective_sum.hpp"

#include <algorithm>

namespace muldi::control {

ObjectiveSum::ObjectiveSum(const Problem& problem, std::span<const WeightedObjective> objectives)
    : problem_(problem),
      squares_(problem.controls.size(), 0.0),
      changes_(problem.controls.size(), 0.0),
      peak_factors_(problem.controls.size(), 0.0),
      coordinates_(static_cast<std::size_t>(problem.horizon.n_steps + 1)),
      points_(static_cast<std::size_t>(problem.horizon.n_steps + 1)) {
  for (const WeightedObjective& objective : objectives) {
    weight_ = objective.weight;
    if (weight_ == 0.0) continue;
    std::visit([&](const auto& of) { of.contribute(*this); }, objective.objective);
  }
}

void ObjectiveSum::add_squared_control(int choice, double factor) {
  squares_[static_cast<std::size_t>(choice)] += weight_ * factor;
}

void ObjectiveSum::add_squared_change(int choice, double factor) {
  changes_[static_cast<std::size_t>(choice)] += weight_ * factor;
}

void ObjectiveSum::add_squared_coordinate(int node, const SquaredCoordinate& term) {
  coordinates_[static_cast<std::size_t>(node)].push_back({term.rate, term.cut, term.wanted, weight_ * term.factor});
}

void ObjectiveSum::add_squared_point(int node, const SquaredPoint& term) {
  points_[static_cast<std::size_t>(node)].push_back({term.point, term.component, term.wanted, weight_ * term.factor});
}

void ObjectiveSum::add_peak(const std::vector<double>& factors) {
  peak_weight_ += weight_;
  for (std::size_t c = 0; c < factors.size(); ++c) peak_factors_[c] = std::max(peak_factors_[c], factors[c]);
}

std::vector<std::vector<int>> ObjectiveSum::bind(const model::Chart& chart) {
  std::vector<std::vector<int>> all;
  cuts_.assign(coordinates_.size(), {});
  for (std::size_t n = 0; n < coordinates_.size(); ++n) {
    for (const SquaredCoordinate& term : coordinates_[n]) {
      if (!term.cut) continue;
      cuts_[n].push_back({.coordinate = {*term.cut, chart}, .wanted = term.wanted, .factor = term.factor});
      all.push_back(cuts_[n].back().coordinate.columns());
    }
  }
  for (const auto& points : points_) {
    for (const SquaredPoint& term : points) all.push_back(columns_of(term.point, chart));
  }
  return all;
}

bool ObjectiveSum::follows_time() const {
  // Terms at inner nodes are wanted at certain times.
  for (std::size_t n = 0; n + 1 < coordinates_.size(); ++n) {
    if (!coordinates_[n].empty() || !points_[n].empty()) return true;
  }
  return false;
}

double ObjectiveSum::value(const Eigen::VectorXd& unknowns, const Layout& layout,
                           const DiscreteDynamics& dynamics) const {
  double sum = duration_ * layout.n_steps * dynamics.step();
  for (int c = 0; c < layout.n_u; ++c) {
    const auto at = static_cast<std::size_t>(c);
    const ControlChoice& choice = problem_.controls[at];
    const double square = choice.reference * choice.reference;
    for (int k = 0; k < layout.n_steps; ++k) {
      const double w = unknowns[layout.w(k, c)];
      sum += squares_[at] * square * (choice.kind == ControlKind::squared ? w : w * w);
      if (k == 0) continue;
      const double change = w - unknowns[layout.w(k - 1, c)];
      sum += changes_[at] * change * change;
    }
  }
  for (int n = 0; n <= layout.n_steps; ++n) {
    for (const SquaredCoordinate& term : coordinates_[static_cast<std::size_t>(n)]) {
      if (term.cut) continue;
      const double off = dynamics.node(n).theta[term.rate] - term.wanted;
      sum += term.factor * off * off;
    }
    for (const SquaredCut& term : cuts_[static_cast<std::size_t>(n)]) {
      const double off = term.coordinate.offset(dynamics.node(n).point, term.wanted);
      sum += term.factor * off * off;
    }
    for (const SquaredPoint& term : points_[static_cast<std::size_t>(n)]) {
      const double off = term.point.value(dynamics.node(n).point.q)[term.component] - term.wanted;
      sum += term.factor * off * off;
    }
  }
  if (has_kinetic_energy()) {
    const EndMotion& end = layout.motion[1];
    sum += 0.5 * kinetic_ * unknowns.segment(end.rates, layout.n_v).dot(unknowns.segment(end.momenta, layout.n_v));
  }
  if (has_peak()) sum += peak_weight_ * unknowns[layout.peak];
  return sum;
}

void ObjectiveSum::add_gradient(const Eigen::VectorXd& unknowns, const Layout& layout, const DiscreteDynamics& dynamics,
                                Eigen::VectorXd& out) const {
  if (layout.step >= 0) out[layout.step] += duration_ * layout.n_steps;
  for (int c = 0; c < layout.n_u; ++c) {
    const auto at = static_cast<std::size_t>(c);
    const ControlChoice& choice = problem_.controls[at];
    const double square = squares_[at] * choice.reference * choice.reference;
    for (int k = 0; k < layout.n_steps; ++k) {
      const int place = layout.w(k, c);
      out[place] += choice.kind == ControlKind::squared ? square : 2.0 * square * unknowns[place];
      if (k == 0) continue;
      const double change = 2.0 * changes_[at] * (unknowns[place] - unknowns[layout.w(k - 1, c)]);
      out[place] += change;
      out[layout.w(k - 1, c)] -= change;
    }
  }
  for (int n = 0; n <= layout.n_steps; ++n) {
    const DynamicsNode& node = dynamics.node(n);
    for (const SquaredCoordinate& term : coordinates_[static_cast<std::size_t>(n)]) {
      if (!term.cut) out[layout.theta(n, term.rate)] += 2.0 * term.factor * (node.theta[term.rate] - term.wanted);
    }
    for (const SquaredCut& term : cuts_[static_cast<std::size_t>(n)]) {
      const double off = term.coordinate.offset(node.point, term.wanted);
      out.segment(layout.theta(n, 0), layout.n_v) +=
          2.0 * term.factor * off * term.coordinate.gradient(node.point).transpose();
    }
    Eigen::MatrixXd block(3, layout.n_v);
    for (const SquaredPoint& term : points_[static_cast<std::size_t>(n)]) {
      const double off = term.point.value(node.point.q)[term.component] - term.wanted;
      project_point(term.point, node.point.D, block);
      out.segment(layout.theta(n, 0), layout.n_v) += 2.0 * term.factor * off * block.row(term.component).transpose();
    }
  }
  if (has_kinetic_energy()) {
    const EndMotion& end = layout.motion[1];
    out.segment(end.rates, layout.n_v) += 0.5 * kinetic_ * unknowns.segment(end.momenta, layout.n_v);
    out.segment(end.momenta, layout.n_v) += 0.5 * kinetic_ * unknowns.segment(end.rates, layout.n_v);
  }
  if (has_peak()) out[layout.peak] += peak_weight_;
}

void ObjectiveSum::add_hessian(double factor, const Layout& layout, const DiscreteDynamics& dynamics,
                               DynamicsHessian& out) const {
  for (int c = 0; c < layout.n_u; ++c) {
    const auto at = static_cast<std::size_t>(c);
    const ControlChoice& choice = problem_.controls[at];
    const double square =
        choice.kind == ControlKind::squared ? 0.0 : squares_[at] * choice.reference * choice.reference;
    for (int k = 0; k < layout.n_steps; ++k) {
      const int neighbours = (k > 0 ? 1 : 0) + (k + 1 < layout.n_steps ? 1 : 0);
      out.ww[static_cast<std::size_t>(k)](c, c) += 2.0 * factor * (square + neighbours * changes_[at]);
    }
  }
  Eigen::MatrixXd block(3, layout.n_v);
  for (int n = 0; n <= layout.n_steps; ++n) {
    const auto at = static_cast<std::size_t>(n);
    const DynamicsNode& node = dynamics.node(n);
    for (const SquaredCoordinate& term : coordinates_[at]) {
      if (!term.cut) out.diagonal[at](term.rate, term.rate) += 2.0 * factor * term.factor;
    }
    for (const SquaredCut& term : cuts_[at]) {
      const double weight = 2.0 * factor * term.factor;
      const Eigen::RowVectorXd gradient = term.coordinate.gradient(node.point);
      out.diagonal[at].noalias() += weight * gradient.transpose() * gradient;
      term.coordinate.add_hessian(weight * term.coordinate.offset(node.point, term.wanted), node.point, out.y[at],
                                  out.diagonal[at]);
    }
    for (const SquaredPoint& term : points_[at]) {
      const double off = term.point.value(node.point.q)[term.component] - term.wanted;
      project_point(term.point, node.point.D, block);
      out.diagonal[at].noalias() +=
          2.0 * factor * term.factor * block.row(term.component).transpose() * block.row(term.component);
      term.point.add_transposed(2.0 * factor * term.factor * off * Eigen::Vector3d::Unit(term.component), out.y[at]);
    }
  }
}

}  // namespace muldi::control
