/// What can be known before a solve.
#include <algorithm>

#include "control/transcription.hpp"

namespace muldi::control {
namespace {

/// dL/dq + f in the scene pose at rest with one control at u, the others at 0, and the forces on the rates behind it.
Eigen::VectorXd forces_with(const model::Model& model, int control, double u) {
  const model::Manifold& manifold = *model.manifold;
  const Eigen::VectorXd x = manifold.reference();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.n_q());
  const Eigen::VectorXd zero = q;
  manifold.configuration(x, q);
  std::vector<double> all(model.controls.size(), 0.0);
  all[static_cast<std::size_t>(control)] = u;
  const std::span<const double> view(x.data(), static_cast<std::size_t>(x.size()));
  model::IntervalForces forces{.force = zero, .momentum = zero};
  forces.on_rates = Eigen::VectorXd::Zero(manifold.n_v());
  model.forces({.q0 = q, .q1 = q, .q = q, .v = zero, .u = all, .x0 = view, .x1 = view}, forces);
  Eigen::VectorXd out(zero.size() + forces.on_rates.size());
  out << forces.force, forces.on_rates;
  return out;
}

void find_control_faults(const Problem& problem, std::vector<Fault>& faults) {
  if (problem.controls.empty()) faults.push_back({"controls", "no control is sought: name at least one"});
  for (const ControlChoice& choice : problem.controls) {
    const std::string where = "controls." + problem.model.controls[static_cast<std::size_t>(choice.control)].name;
    if (!(choice.lower <= choice.upper)) faults.push_back({where, "the lower bound is above the upper one"});
    if (choice.kind == ControlKind::squared && choice.lower < 0.0) {
      faults.push_back({where, "only the square of this control acts: its bounds must not be negative"});
    }
    if (!(choice.reference > 0.0)) faults.push_back({where, "its reference must be positive"});
  }
  if (!problem.horizon.is_free()) return;
  for (std::size_t c = 0; c < problem.model.controls.size(); ++c) {
    const bool sought = std::any_of(problem.controls.begin(), problem.controls.end(), [&](const ControlChoice& choice) {
      return static_cast<std::size_t>(choice.control) == c;
    });
    if (sought || problem.model.controls[c].function.is_constant()) continue;
    faults.push_back({"controls", "'" + problem.model.controls[c].name +
                                      "' is a function of time and is not sought, but the duration is free: make it "
                                      "constant, seek it, or fix the duration"});
  }
}

}  // namespace

ControlKind kind_of_control(const model::Model& model, int control) {
  constexpr double unit = 1e4;  // of a field in V/mm a natural value; linear and quadratic forces have no scale
  const Eigen::VectorXd none = forces_with(model, control, 0.0);
  const Eigen::VectorXd single = forces_with(model, control, unit) - none;
  const Eigen::VectorXd twice = forces_with(model, control, 2.0 * unit) - none;
  const double size = twice.norm();
  const bool quadratic = size > 0.0 && (twice - 4.0 * single).norm() < 1e-9 * size;
  return quadratic ? ControlKind::squared : ControlKind::plain;
}

std::vector<Fault> find_faults(const Problem& problem, const Trajectory& guess) {
  std::vector<Fault> faults;
  if (problem.horizon.n_steps < 1) faults.push_back({"duration", "the horizon has no step"});
  if (!(problem.horizon.shortest_step > 0.0) || problem.horizon.shortest_step > problem.horizon.longest_step) {
    faults.push_back({"duration", "the shortest step must be positive and not above the longest"});
  }
  if (!problem.model.substructures.empty()) {
    faults.push_back({"",
                      "finite elements cannot be optimised: give the muscles `model: lumped` and replay the controls "
                      "on finite elements"});
  }
  for (const CoordinateLimit& limit : problem.limits.coordinates) {
    if (limit.lower > limit.upper) faults.push_back({"limits." + limit.name, "the lower bound is above the upper one"});
  }
  for (const PointLimit& limit : problem.limits.points) {
    if ((limit.lower.array() > limit.upper.array()).any()) {
      faults.push_back({"limits." + limit.name, "a lower bound is above the upper one"});
    }
  }
  find_control_faults(problem, faults);
  if (!faults.empty()) return faults;
  const Transcription transcription(problem, {}, refined_guess(problem, guess));
  return transcription.faults();
}

}  // namespace muldi::control
