/// Trajectories as unknowns and back; what unknowns and rows are.
#include <algorithm>

#include "control/transcription.hpp"

namespace muldi::control {

double Transcription::impulse_weight(int node, double step) const {
  return node == 0 || node == layout_.n_steps ? 0.5 * step : step;
}

Eigen::VectorXd Transcription::unknowns_of(const Trajectory& trajectory) const {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(layout_.n);
  Eigen::VectorXd theta(layout_.n_v);
  for (int n = 0; n <= layout_.n_steps; ++n) {
    const auto at = static_cast<std::size_t>(n);
    dynamics_->node(n).chart->coordinates(trajectory.x[at], theta);
    x.segment(layout_.theta(n, 0), layout_.n_v) = theta;
    if (layout_.lambda(n, 0) >= 0 && at < trajectory.multipliers.size()) {
      x.segment(layout_.lambda(n, 0), layout_.n_c) =
          impulse_weight(n, trajectory.step) * (dynamics_->node(n).Z.transpose() * trajectory.multipliers[at]);
    }
    for (int c = 0; c < layout_.n_u && n < layout_.n_steps; ++c) {
      const auto control = static_cast<std::size_t>(problem_.controls[static_cast<std::size_t>(c)].control);
      x[layout_.w(n, c)] = dynamics_->control_unknown(c, trajectory.u[at][control]);
    }
  }
  if (layout_.step >= 0) x[layout_.step] = trajectory.step;
  if (layout_.equilibrium_lambda >= 0)
    x.segment(layout_.equilibrium_lambda, layout_.n_c) = ends_[1]->pose_multipliers();
  x = x.cwiseQuotient(scale_x_);
  x = x.cwiseMax(bounds_.x_lower).cwiseMin(bounds_.x_upper);
  if (layout_.peak < 0) return x;
  for (int k = 0; k < layout_.n_steps; ++k) {
    for (int c = 0; c < layout_.n_u; ++c) {
      const double u = dynamics_->control_value(c, x[layout_.w(k, c)]);
      const double value = objectives_.peak_factors()[static_cast<std::size_t>(c)] * u * u / scale_x_[layout_.peak];
      x[layout_.peak] = std::max(x[layout_.peak], value);
    }
  }
  return x;
}

Trajectory Transcription::trajectory_of(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd unknowns = x.cwiseProduct(scale_x_);
  Trajectory out{.step = layout_.step >= 0 ? unknowns[layout_.step] : problem_.horizon.shortest_step};
  for (int n = 0; n <= layout_.n_steps; ++n) {
    Eigen::VectorXd at(problem_.model.manifold->n_x());
    dynamics_->node(n).chart->stored(unknowns.segment(layout_.theta(n, 0), layout_.n_v), at);
    out.x.push_back(std::move(at));
    if (layout_.n_c > 0) {
      out.multipliers.push_back(
          layout_.lambda(n, 0) < 0
              ? Eigen::VectorXd(Eigen::VectorXd::Zero(problem_.model.manifold->n_loop_rows()))
              : Eigen::VectorXd(dynamics_->node(n).Z * unknowns.segment(layout_.lambda(n, 0), layout_.n_c) /
                                impulse_weight(n, out.step)));
    }
    if (n == layout_.n_steps) break;
    std::vector<double> u;
    problem_.model.evaluate_controls((n + 0.5) * out.step, u);
    for (int c = 0; c < layout_.n_u; ++c) {
      u[static_cast<std::size_t>(problem_.controls[static_cast<std::size_t>(c)].control)] =
          dynamics_->control_value(c, unknowns[layout_.w(n, c)]);
    }
    out.u.push_back(std::move(u));
  }
  return out;
}

Transcription::Place Transcription::row_place(int row) const {
  for (int end = 0; end < 2; ++end) {
    const auto e = static_cast<std::size_t>(end);
    const int node = end == 0 ? 0 : layout_.n_steps;
    if (row >= end_row_[e] && row < end_row_[e] + ends_[e]->n_rows()) return {ends_[e]->name(row - end_row_[e]), node};
    if (motions_[e] && row >= motion_row_[e] && row < motion_row_[e] + motions_[e]->n_rows()) {
      return {end == 0 ? "initial.momentum" : "final.momentum", node};
    }
  }
  if (row >= peak_row_) return {"peak_field", 0};
  if (row >= turn_row_) return {"longest turn in a step", (row - turn_row_) % layout_.n_steps};
  if (row >= limit_row_) {
    const LimitRow& limit = limits_->rows()[static_cast<std::size_t>(row - limit_row_)];
    return {limit.name, limit.node};
  }
  for (int n = layout_.n_steps; n >= 0; --n) {
    const auto at = static_cast<std::size_t>(n);
    if (closing_row_[at] >= 0 && row >= closing_row_[at]) return {"closed loops", n};
    if (balance_row_[at] < 0 || row < balance_row_[at]) continue;
    if (n == layout_.n_steps) return {"final.momentum", n};
    return {n == 0 ? "initial.momentum" : "equation of motion", n};
  }
  return {"equation of motion", 0};
}

Transcription::Place Transcription::variable_place(int variable) const {
  for (int n = layout_.n_steps; n >= 0; --n) {
    const int first = layout_.theta(n, 0);
    if (variable < first) continue;
    const int local = variable - first;
    if (local < layout_.n_v) {
      for (const CoordinateLimit& limit : problem_.limits.coordinates) {
        if (!limit.cut && limit.rate == local) return {"limits." + limit.name, n};
      }
      return {"", n};
    }
    if (n < layout_.n_steps && local < layout_.n_v + layout_.n_u) {
      const int control = problem_.controls[static_cast<std::size_t>(local - layout_.n_v)].control;
      return {problem_.model.controls[static_cast<std::size_t>(control)].name, n};
    }
    break;
  }
  return {variable == layout_.step ? "duration" : "", 0};
}

}  // namespace muldi::control
