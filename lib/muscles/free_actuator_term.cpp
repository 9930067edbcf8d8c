#include "muscles/free_actuator_term.hpp"

#include <cstddef>
#include <utility>

namespace muldi::muscles {
namespace {

AxialDerivatives<double, 1> derivatives(const FreeActuator& actuator, const model::IntervalPoint& at) {
  return actuator.element.axial(at.q[actuator.dof], at.v[actuator.dof], {actuator.field.value(at.u)});
}

}  // namespace

FreeActuatorTerm::FreeActuatorTerm(std::vector<FreeActuator> actuators) : actuators_(std::move(actuators)) {
  for (FreeActuator& actuator : actuators_) actuator.element.inertia = Inertia::thesis;
}

void FreeActuatorTerm::request(model::PatternRequest& pattern) const {
  for (const FreeActuator& actuator : actuators_) pattern.add_pair(actuator.node, actuator.node);
}

void FreeActuatorTerm::bind(const math::BlockPattern& pattern) {
  slots_.clear();
  for (const FreeActuator& actuator : actuators_) {
    math::BlockSlot slot = pattern.slot(actuator.node, actuator.node);
    const int local = actuator.dof - pattern.offset(actuator.node);
    slot.first += local * (slot.stride + 1);
    slots_.push_back(slot);
  }
}

void FreeActuatorTerm::add_forces(const model::IntervalPoint& at, model::IntervalForces& out) const {
  for (const FreeActuator& actuator : actuators_) {
    const auto d = derivatives(actuator, at);
    out.force[actuator.dof] += d.l_z + d.f;
    out.momentum[actuator.dof] += d.l_d;
  }
}

void FreeActuatorTerm::add_tangent(const model::IntervalPoint& at, const model::TangentWeights& weights,
                                   math::BlockMatrix& K) const {
  for (std::size_t k = 0; k < actuators_.size(); ++k) {
    const auto d = derivatives(actuators_[k], at);
    *K.data(slots_[k]) +=
        weights.vv * d.l_dd + weights.vq * d.l_zd + weights.qv * (d.l_zd + d.f_d) + weights.qq * (d.l_zz + d.f_z);
  }
}

void FreeActuatorTerm::add_control_force(const model::IntervalPoint& at, int control, Eigen::VectorXd& out) const {
  for (const FreeActuator& actuator : actuators_) {
    if (actuator.field.control != control) continue;
    out[actuator.dof] += actuator.field.factor * derivatives(actuator, at).h_e[0];
  }
}

model::IntervalWork FreeActuatorTerm::work(const model::IntervalPoint& at) const {
  model::IntervalWork total;
  for (const FreeActuator& actuator : actuators_) {
    total.dissipated -= at.dt * derivatives(actuator, at).f * at.v[actuator.dof];
  }
  return total;
}

std::vector<std::string> FreeActuatorTerm::parts() const {
  std::vector<std::string> names;
  for (const FreeActuator& actuator : actuators_) names.push_back(std::string(LumpedDea::folder) + "/" + actuator.name);
  return names;
}

void FreeActuatorTerm::energies(const model::NodePoint& at, std::span<model::Energy> out) const {
  for (std::size_t k = 0; k < actuators_.size(); ++k) {
    const FreeActuator& actuator = actuators_[k];
    const double z = at.q[actuator.dof];
    out[k] += {.kinetic = actuator.element.kinetic(z, at.v[actuator.dof]),
               .elastic = actuator.element.elastic(z),
               .electric = actuator.element.electric(z, Controls<double, 1>{actuator.field.value(at.u)})};
  }
}

std::string FreeActuatorTerm::inadmissible(const Eigen::VectorXd& q) const {
  for (const FreeActuator& actuator : actuators_) {
    const std::string why = actuator.element.inadmissible(q[actuator.dof]);
    if (!why.empty()) return std::string(LumpedDea::noun) + " '" + actuator.name + "': " + why;
  }
  return {};
}

}  // namespace muldi::muscles
