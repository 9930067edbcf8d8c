/// Trajectories to start from.
#include <algorithm>
#include <cmath>

#include "control/solve.hpp"
#include "variational/node_values.hpp"
#include "variational/stepper.hpp"

namespace muldi::control {
namespace {

/// The pose in which the horizon begins, as far as the conditions say it directly.
Eigen::VectorXd initial_pose(const Problem& problem) {
  const model::Manifold& manifold = *problem.model.manifold;
  if (problem.initial.x) return *problem.initial.x;
  const auto chart = manifold.make_chart();
  Eigen::VectorXd theta(manifold.n_v());
  chart->coordinates(manifold.reference(), theta);
  for (const CoordinateTarget& target : problem.initial.coordinates) {
    if (!target.cut) theta[target.rate] = target.value;
  }
  Eigen::VectorXd x(manifold.n_x());
  chart->stored(theta, x);
  return x;
}

variational::State initial_state(const Problem& problem) {
  const model::Model& model = problem.model;
  const model::Manifold& manifold = *model.manifold;
  variational::State state;
  state.x = initial_pose(problem);
  state.q = state.p = Eigen::VectorXd::Zero(model.n_q());
  manifold.configuration(state.x, state.q);
  state.increment = Eigen::VectorXd::Zero(manifold.n_v());
  state.multipliers = Eigen::VectorXd::Zero(manifold.n_loop_rows());
  if (problem.initial.momentum.kind != MomentumCondition::Kind::rates) return state;
  const auto frame = manifold.make_frame();
  manifold.update(state.x, state.q, *frame);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(model.n_q());
  manifold.lift(*frame, problem.initial.momentum.values, v);
  std::vector<double> u;
  model.evaluate_controls(0.0, u);
  variational::NodeEvaluator(model, "auto").momentum_of(state.q, v, u, state.p);
  return state;
}

}  // namespace

Trajectory simulate_guess(const Problem& problem, double step, const std::vector<std::vector<double>>& u) {
  variational::Stepper stepper(problem.model, step, {});
  variational::State state = initial_state(problem);
  Trajectory out{.step = step, .x = {state.x}, .u = u};
  bool runs = true;
  for (int k = 0; k < problem.horizon.n_steps; ++k) {
    if (runs) {
      runs = stepper.advance(state, u[static_cast<std::size_t>(k)]).status == variational::Status::running;
      if (runs) out.multipliers.push_back(state.multipliers);
    }
    out.x.push_back(state.x);
  }
  out.multipliers.resize(out.x.size(), Eigen::VectorXd::Zero(problem.model.manifold->n_loop_rows()));
  return out;
}

Trajectory resting_guess(const Problem& problem, double step) {
  const auto n = static_cast<std::size_t>(problem.horizon.n_steps);
  std::vector<double> u;
  problem.model.evaluate_controls(0.0, u);
  for (const ControlChoice& choice : problem.controls) {
    const double value = std::isfinite(choice.lower) ? choice.lower : std::min(choice.upper, 0.0);
    u[static_cast<std::size_t>(choice.control)] = value;
  }
  const Eigen::VectorXd pose = initial_pose(problem);
  Trajectory out{.step = step};
  out.x.assign(n + 1, pose);
  out.u.assign(n, u);
  return out;
}

Trajectory refined_guess(const Problem& problem, const Trajectory& coarse) {
  const auto n = static_cast<std::size_t>(problem.horizon.n_steps);
  const std::size_t n_coarse = coarse.u.size();
  const model::Manifold& manifold = *problem.model.manifold;
  if (n_coarse == n || n_coarse == 0 || coarse.x.size() < 2) return coarse;
  Trajectory out{.step = coarse.step * static_cast<double>(n_coarse) / static_cast<double>(n)};
  const double ratio = static_cast<double>(n_coarse) / static_cast<double>(n);
  Eigen::VectorXd increment(manifold.n_v());
  for (std::size_t i = 0; i <= n; ++i) {
    const double at = static_cast<double>(i) * ratio;
    const std::size_t left = std::min(static_cast<std::size_t>(at), n_coarse - 1);
    const double part = at - static_cast<double>(left);
    manifold.difference(coarse.x[left], coarse.x[left + 1], increment);
    Eigen::VectorXd x = coarse.x[left];
    manifold.retract(coarse.x[left], part * increment, x);
    out.x.push_back(std::move(x));
    if (!coarse.multipliers.empty()) {
      out.multipliers.push_back((1.0 - part) * coarse.multipliers[left] + part * coarse.multipliers[left + 1]);
    }
    if (i == n) break;
    const double middle = (static_cast<double>(i) + 0.5) * ratio;
    out.u.push_back(coarse.u[std::min(static_cast<std::size_t>(middle), n_coarse - 1)]);
  }
  return out;
}

}  // namespace muldi::control
