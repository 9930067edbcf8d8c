#include "multibody/joint_forces.hpp"

#include <algorithm>

namespace muldi::multibody {

JointForce::Response JointForce::respond(double position, double rate, std::span<const double> u) const {
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

double JointForce::potential(double position) const {
  const double stretch = position - rest;
  const double outside = std::min(position - stops.lower, 0.0) + std::max(position - stops.upper, 0.0);
  return 0.5 * stiffness * stretch * stretch + 0.5 * stops.stiffness * (outside == 0.0 ? 0.0 : outside * outside);
}

JointForces::JointForces(std::vector<JointForce> forces) : forces_(std::move(forces)) {
  for (const JointForce& force : forces_) {
    const auto known = std::find(parts_.begin(), parts_.end(), force.part);
    part_of_.push_back(static_cast<std::size_t>(known - parts_.begin()));
    if (known == parts_.end()) parts_.push_back(force.part);
  }
}

void JointForces::request(model::PatternRequest& pattern) const {
  for (const JointForce& force : forces_) pattern.add_clique(force.coordinate.nodes());
}

void JointForces::bind(const math::BlockPattern& pattern) {
  slots_.assign(forces_.size(), {});
  for (std::size_t f = 0; f < forces_.size(); ++f) {
    const auto nodes = forces_[f].coordinate.nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (std::size_t j = 0; j < nodes.size(); ++j) slots_[f][2 * i + j] = pattern.slot(nodes[i], nodes[j]);
  }
}

void JointForces::add_forces(const model::IntervalPoint& at, model::IntervalForces& out) const {
  for (const JointForce& force : forces_) {
    const double position = force.coordinate.value(at.q, at.x0, at.x1);
    const double rate = force.coordinate.rate(at.q, at.v);
    force.coordinate.add_gradient(at.q, force.respond(position, rate, at.u).force, out.force);
  }
}

void JointForces::add_tangent(const model::IntervalPoint& at, const model::TangentWeights& weights,
                              math::BlockMatrix& K) const {
  if (weights.qq == 0.0 && weights.qv == 0.0) return;
  JointCoordinate::LocalVector gradient;
  JointCoordinate::LocalMatrix hessian;
  JointCoordinate::LocalVector v = JointCoordinate::LocalVector::Zero();
  for (std::size_t f = 0; f < forces_.size(); ++f) {
    const JointForce& force = forces_[f];
    const auto nodes = force.coordinate.nodes();
    force.coordinate.derivatives(at.q, gradient, hessian);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      v.segment<12>(static_cast<Eigen::Index>(12 * i)) = at.v.segment<12>(12 * nodes[i]);
    }
    const double rate = gradient.dot(v);
    const JointForce::Response r = force.respond(force.coordinate.value(at.q, at.x0, at.x1), rate, at.u);
    // f = Q grad: f_q = Q_theta grad grad^T + Q_rate grad (H v)^T + Q H,  f_v = Q_rate grad grad^T.
    const JointCoordinate::LocalVector right =
        (weights.qq * r.by_position + weights.qv * r.by_rate) * gradient + weights.qq * r.by_rate * (hessian * v);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      for (std::size_t j = 0; j < nodes.size(); ++j) {
        const auto row = static_cast<Eigen::Index>(12 * i);
        const auto column = static_cast<Eigen::Index>(12 * j);
        const math::BlockSlot& slot = slots_[f][2 * i + j];
        Eigen::Map<Eigen::Matrix<double, 12, 12, Eigen::RowMajor>, 0, Eigen::OuterStride<>> block(
            K.data(slot), Eigen::OuterStride<>(slot.stride));
        block += weights.qq * r.force * hessian.block<12, 12>(row, column);
        block.noalias() += gradient.segment<12>(row) * right.segment<12>(column).transpose();
      }
    }
  }
}

void JointForces::add_control_force(const model::IntervalPoint& at, int control, Eigen::VectorXd& out) const {
  for (const JointForce& force : forces_) {
    if (force.control == control) force.coordinate.add_gradient(at.q, force.control_factor, out);
  }
}

model::IntervalWork JointForces::work(const model::IntervalPoint& at) const {
  model::IntervalWork work;
  for (const JointForce& force : forces_) {
    const double rate = force.coordinate.rate(at.q, at.v);
    const JointForce::Response r = force.respond(force.coordinate.value(at.q, at.x0, at.x1), rate, at.u);
    work.dissipated -= at.dt * r.damping_force * rate;
    work.external += at.dt * r.drive * rate;
  }
  return work;
}

void JointForces::energies(const model::NodePoint& at, std::span<model::Energy> out) const {
  for (std::size_t f = 0; f < forces_.size(); ++f) {
    const double position = forces_[f].coordinate.value(at.q, at.x, at.x);
    out[part_of_[f]].elastic += forces_[f].potential(position);
  }
}

}  // namespace muldi::multibody
