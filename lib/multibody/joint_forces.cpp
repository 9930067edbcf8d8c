#include "multibody/joint_forces.hpp"

#include <algorithm>

namespace muldi::multibody {
namespace {

JointForce::Motion middle_of(const model::IntervalPoint& at, int coordinate) {
  const double begin = at.x0[static_cast<std::size_t>(coordinate)];
  const double end = at.x1[static_cast<std::size_t>(coordinate)];
  return {.position = 0.5 * (begin + end), .rate = at.dt > 0.0 ? (end - begin) / at.dt : 0.0};
}

}  // namespace

JointForce::Response JointForce::respond(const Motion& middle, std::span<const double> u) const {
  const auto [position, rate] = middle;
  Response r{.force = 0.0,
             .by_position = -stiffness,
             .by_rate = -damping,
             .damping_force = -damping * rate,
             .drive = constant};
  double elastic = -stiffness * (position - rest);
  const double outside = position < stops.lower   ? position - stops.lower
                         : position > stops.upper ? position - stops.upper
                                                  : 0.0;
  if (outside != 0.0) {
    elastic -= stops.stiffness * outside;
    r.by_position -= stops.stiffness;
    r.by_rate -= stops.damping;
    r.damping_force -= stops.damping * rate;
  }
  if (control >= 0) r.drive += control_factor * u[static_cast<std::size_t>(control)];
  r.force = elastic + r.damping_force + r.drive;
  return r;
}

Eigen::RowVector3d JointForce::derivatives(const Response& response) const {
  return {response.by_position, response.by_rate, control < 0 ? 0.0 : control_factor};
}

void JointForce::add_work(const Motion& middle, std::span<const double> u, double dt, model::IntervalWork& work) const {
  const Response r = respond(middle, u);
  work.dissipated -= dt * r.damping_force * middle.rate;
  work.external += dt * r.drive * middle.rate;
}

double JointForce::potential(double position) const {
  const double stretch = position - rest;
  const double outside = std::min(position - stops.lower, 0.0) + std::max(position - stops.upper, 0.0);
  return 0.5 * stiffness * stretch * stretch + 0.5 * stops.stiffness * (outside == 0.0 ? 0.0 : outside * outside);
}

void ForceParts::add(const JointForce& force) {
  const auto known = std::find(names.begin(), names.end(), force.part);
  of.push_back(static_cast<std::size_t>(known - names.begin()));
  if (known == names.end()) names.push_back(force.part);
}

JointForces::JointForces(std::vector<TreeJointForce> forces) : forces_(std::move(forces)) {
  for (const TreeJointForce& force : forces_) parts_.add(force.law);
}

void JointForces::add_forces(const model::IntervalPoint& at, model::IntervalForces& out) const {
  if (at.x0.empty()) return;
  for (const TreeJointForce& force : forces_) {
    out.on_rates[force.rate] += force.law.respond(middle_of(at, force.coordinate), at.u).force;
  }
}

void JointForces::add_rate_tangent(const model::IntervalPoint& at, const model::TangentWeights& weights,
                                   Eigen::VectorXd& diagonal) const {
  if (weights.qq == 0.0 && weights.qv == 0.0) return;
  for (const TreeJointForce& force : forces_) {
    const JointForce::Response r = force.law.respond(middle_of(at, force.coordinate), at.u);
    diagonal[force.rate] += weights.qq * r.by_position + weights.qv * r.by_rate;
  }
}

void JointForces::add_control_force_on_rates(const model::IntervalPoint&, int control, Eigen::VectorXd& out) const {
  for (const TreeJointForce& force : forces_) {
    if (force.law.control == control) out[force.rate] += force.law.control_factor;
  }
}

bool JointForces::expand(const model::IntervalPoint& at, const model::ExpansionRequest& request,
                         model::ExpansionSink& sink) const {
  Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(2, 3);
  const Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(3, 3);
  for (const TreeJointForce& force : forces_) {
    const int control = force.law.control;
    if (control >= 0 && request.squared[static_cast<std::size_t>(control)] != 0.0) return false;
    const JointForce::Response r = force.law.respond(middle_of(at, force.coordinate), at.u);
    tangent.row(0) = force.law.derivatives(r);
    sink.add({.rate = force.rate},
             {.controls = {&control, 1}, .tangent = tangent, .hessian = request.a != nullptr ? &hessian : nullptr});
  }
  return true;
}

model::IntervalWork JointForces::work(const model::IntervalPoint& at) const {
  model::IntervalWork work;
  for (const TreeJointForce& force : forces_) {
    force.law.add_work(middle_of(at, force.coordinate), at.u, at.dt, work);
  }
  return work;
}

void JointForces::energies(const model::NodePoint& at, std::span<model::Energy> out) const {
  for (std::size_t f = 0; f < forces_.size(); ++f) {
    const double position = at.x[static_cast<std::size_t>(forces_[f].coordinate)];
    out[parts_.of[f]].elastic += forces_[f].law.potential(position);
  }
}

}  // namespace muldi::multibody
