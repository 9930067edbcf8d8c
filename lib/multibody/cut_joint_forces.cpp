#include "multibody/cut_joint_forces.hpp"

namespace muldi::multibody {
namespace {

JointForce::Motion middle_of(const model::IntervalPoint& at, const JointCoordinate& coordinate) {
  if (!(at.dt > 0.0)) return {.position = coordinate.value(at.q1)};
  const double advance = coordinate.advance(at.q0, at.q1);
  return {.position = coordinate.value(at.q0) + 0.5 * advance, .rate = advance / at.dt};
}

}  // namespace

CutJointForces::CutJointForces(std::vector<CutJointForce> forces) : forces_(std::move(forces)) {
  for (const CutJointForce& force : forces_) parts_.add(force.law);
}

void CutJointForces::request(model::PatternRequest& pattern) const {
  for (const CutJointForce& force : forces_) pattern.add_clique(force.coordinate.nodes());
}

void CutJointForces::bind(const math::BlockPattern& pattern) {
  slots_.assign(forces_.size(), {});
  for (std::size_t f = 0; f < forces_.size(); ++f) {
    const auto nodes = forces_[f].coordinate.nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (std::size_t j = 0; j < nodes.size(); ++j) slots_[f][2 * i + j] = pattern.slot(nodes[i], nodes[j]);
  }
}

void CutJointForces::add_forces(const model::IntervalPoint& at, model::IntervalForces& out) const {
  for (const CutJointForce& force : forces_) {
    const double Q = force.law.respond(middle_of(at, force.coordinate), at.u).force;
    if (at.dt > 0.0) {
      force.coordinate.add_gradient(at.q0, 0.5 * at.dt * Q, out.begin);
      force.coordinate.add_gradient(at.q1, 0.5 * at.dt * Q, out.end);
    } else {
      force.coordinate.add_gradient(at.q, Q, out.force);
    }
  }
}

void CutJointForces::add_local(std::size_t f, const JointCoordinate::LocalMatrix& A, math::BlockMatrix& K) const {
  const auto nodes = forces_[f].coordinate.nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      const math::BlockSlot& slot = slots_[f][2 * i + j];
      Eigen::Map<Eigen::Matrix<double, 12, 12, Eigen::RowMajor>, 0, Eigen::OuterStride<>> block(
          K.data(slot), Eigen::OuterStride<>(slot.stride));
      block += A.block<12, 12>(static_cast<Eigen::Index>(12 * i), static_cast<Eigen::Index>(12 * j));
    }
  }
}

void CutJointForces::add_tangent(const model::IntervalPoint& at, const model::TangentWeights& weights,
                                 math::BlockMatrix& K) const {
  if (weights.qq == 0.0 && weights.qv == 0.0) return;
  for (std::size_t f = 0; f < forces_.size(); ++f) {
    const CutJointForce& force = forces_[f];
    const JointForce::Response r = force.law.respond(middle_of(at, force.coordinate), at.u);
    // The begin of the interval is fixed: no Hessian of theta is in the matrix of a step.
    const JointCoordinate::LocalVector rows = force.coordinate.gradient(at.q0);
    const JointCoordinate::LocalVector columns = force.coordinate.gradient(at.q1);
    JointCoordinate::LocalMatrix A;
    A.noalias() = rows * ((weights.qq * r.by_position + weights.qv * r.by_rate) * columns).transpose();
    if (!(at.dt > 0.0)) A += weights.qq * r.force * force.coordinate.hessian(at.q);
    add_local(f, A, K);
  }
}

void CutJointForces::add_control_force(const model::IntervalPoint& at, int control, Eigen::VectorXd& out) const {
  for (const CutJointForce& force : forces_) {
    if (force.law.control == control) force.coordinate.add_gradient(at.q, force.law.control_factor, out);
  }
}

bool CutJointForces::expand(const model::IntervalPoint& at, const model::ExpansionRequest& request,
                            model::ExpansionSink& sink) const {
  Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(2, 3);
  const Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(3, 3);
  for (const CutJointForce& force : forces_) {
    const int control = force.law.control;
    if (control >= 0 && request.squared[static_cast<std::size_t>(control)] != 0.0) return false;
    const JointForce::Response r = force.law.respond(middle_of(at, force.coordinate), at.u);
    tangent.row(0) = force.law.derivatives(r);
    sink.add({.coordinate = &force.coordinate}, {.controls = {&control, 1},
                                                 .tangent = tangent,
                                                 .hessian = request.a != nullptr ? &hessian : nullptr,
                                                 .force = r.force});
  }
  return true;
}

model::IntervalWork CutJointForces::work(const model::IntervalPoint& at) const {
  model::IntervalWork work;
  for (const CutJointForce& force : forces_) {
    force.law.add_work(middle_of(at, force.coordinate), at.u, at.dt, work);
  }
  return work;
}

void CutJointForces::energies(const model::NodePoint& at, std::span<model::Energy> out) const {
  for (std::size_t f = 0; f < forces_.size(); ++f) {
    out[parts_.of[f]].elastic += forces_[f].law.potential(forces_[f].coordinate.value(at.q));
  }
}

}  // namespace muldi::multibody
