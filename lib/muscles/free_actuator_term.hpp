#pragma once
/// Isolated actuators as one interval term: the length is the only unknown, no translation, no weight (thesis 7.2).
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "model/interval_term.hpp"
#include "muscles/two_point.hpp"
#include "muscles/two_point_term.hpp"

namespace muldi::muscles {

/// An element whose midpoint rests and whose direction stays: an element of its length alone.
template <TwoPointElement Element>
struct Isolated {
  static constexpr int n_controls = Element::n_controls;

  Element element;

  template <class S>
  S kinetic(const S& z, const S& zd) const {
    if constexpr (AxialElement<Element>) {
      return kinetic_energy(element, z, zd) + end_inertia() * zd * zd;
    } else {
      return element.kinetic(ends(z, zd, Controls<S, n_controls>{}));
    }
  }
  template <class S>
  S elastic(const S& z) const {
    if constexpr (AxialElement<Element>) {
      return element.elastic(z);
    } else {
      return element.elastic(ends(z, S(0.0), Controls<S, n_controls>{}));
    }
  }
  template <class S>
  S electric(const S& z, const Controls<S, n_controls>& e) const {
    if constexpr (AxialElement<Element>) {
      return electric_energy(element, z, e);
    } else {
      return element.electric(ends(z, S(0.0), e));
    }
  }
  template <class S>
  S force(const S& z, const S& zd, const Controls<S, n_controls>& e) const {
    if constexpr (AxialElement<Element>) {
      return element.force(z, zd, e);
    } else {
      return element.force(ends(z, zd, e));
    }
  }
  bool dissipates() const { return element.dissipates(); }

  template <class S>
  AxialDerivatives<S, n_controls> axial(const S& z, const S& zd, const Controls<S, n_controls>& e) const
      requires(AxialElement<Element>) {
    AxialDerivatives<S, n_controls> d = axial_derivatives(element, z, zd, e);
    d.l_d += 2.0 * end_inertia() * zd;
    d.l_dd += 2.0 * end_inertia();
    return d;
  }

 private:
  /// Of zd^2, from ends that move by zd/2 against each other.
  double end_inertia() const {
    const EndMass m = end_mass_of(element);
    return 0.125 * (m.m11 + m.m22 - 2.0 * m.m12);
  }
  template <class S>
  static TwoPoint<S, n_controls> ends(const S& z, const S& zd, const Controls<S, n_controls>& e) {
    TwoPoint<S, n_controls> x;
    const Vector3<S> axis(S(1.0), S(0.0), S(0.0));
    x.a1 = S(0.5 * z) * axis;
    x.a2 = -x.a1;
    x.v1 = S(0.5 * zd) * axis;
    x.v2 = -x.v1;
    x.e = e;
    return x;
  }
};

/// One actuator on its own node of size 1; for a lumped muscle T = m zd^2/48 (k V z^-3 + 2), thesis (7.47) and (7.60).
template <TwoPointElement Element>
struct FreeActuator {
  std::string name;
  Element element;
  int node = 0;  ///< of the block pattern
  int dof = 0;   ///< entry of q that holds the length z
  std::array<ControlInput, static_cast<std::size_t>(Element::n_controls)> controls{};

  AxialState<Element::n_controls> state(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                        std::span<const double> u) const {
    AxialState<Element::n_controls> s{.z = q[dof], .zd = v[dof]};
    for (std::size_t c = 0; c < controls.size(); ++c) s.e[c] = controls[c].value(u);
    return s;
  }
};

template <TwoPointElement Element>
class FreeActuatorTerm final : public model::IntervalTerm {
 public:
  explicit FreeActuatorTerm(std::vector<FreeActuator<Element>> actuators) : actuators_(std::move(actuators)) {}

  const std::vector<FreeActuator<Element>>& actuators() const { return actuators_; }

  void request(model::PatternRequest& pattern) const override {
    for (const auto& actuator : actuators_) pattern.add_pair(actuator.node, actuator.node);
  }

  void bind(const math::BlockPattern& pattern) override {
    slots_.clear();
    for (const auto& actuator : actuators_) {
      math::BlockSlot slot = pattern.slot(actuator.node, actuator.node);
      const int local = actuator.dof - pattern.offset(actuator.node);
      slot.first += local * (slot.stride + 1);
      slots_.push_back(slot);
    }
  }

  void add_forces(const model::IntervalPoint& at, model::IntervalForces& out) const override {
    for (const auto& actuator : actuators_) {
      const auto d = derivatives(actuator, at);
      out.force[actuator.dof] += d.l_z + d.f;
      out.momentum[actuator.dof] += d.l_d;
    }
  }

  void add_tangent(const model::IntervalPoint& at, const model::TangentWeights& weights,
                   math::BlockMatrix& K) const override {
    for (std::size_t k = 0; k < actuators_.size(); ++k) {
      const auto d = derivatives(actuators_[k], at);
      *K.data(slots_[k]) +=
          weights.vv * d.l_dd + weights.vq * d.l_zd + weights.qv * (d.l_zd + d.f_d) + weights.qq * (d.l_zz + d.f_z);
    }
  }

  void add_control_force(const model::IntervalPoint& at, int control, Eigen::VectorXd& out) const override {
    for (const auto& actuator : actuators_) {
      for (std::size_t c = 0; c < actuator.controls.size(); ++c) {
        const ControlInput& input = actuator.controls[c];
        if (input.control != control) continue;
        out[actuator.dof] += input.factor * derivatives(actuator, at).h_e[c];
      }
    }
  }

  /// The length itself: F = g1, pi = g2, Psi = a g1 + b g2.
  bool expand(const model::IntervalPoint& at, const model::ExpansionRequest& request,
              model::ExpansionSink& sink) const override {
    constexpr int n = Element::n_controls;
    if constexpr (AxialElement<Element>) {
      Eigen::MatrixXd tangent(2, 2 + n);
      Eigen::MatrixXd hessian(2 + n, 2 + n);
      for (const auto& actuator : actuators_) {
        const auto s = actuator.state(at.q, at.v, at.u);
        const ControlSlots<n> slots(actuator.controls, request.squared);
        const AxialForces<2 + n> g =
            slots.axial_forces(Isolated<Element>{actuator.element}, s.z, s.zd, s.e, request.a != nullptr);
        for (int k = 0; k < 2 + n; ++k) {
          tangent(0, k) = g.g1.d(k);
          tangent(1, k) = g.g2.d(k);
        }
        slots.scale(tangent, 2);
        if (request.a != nullptr) {
          const double a = (*request.a)[actuator.dof];
          const double b = (*request.b)[actuator.dof];
          for (int i = 0; i < 2 + n; ++i) {
            for (int j = 0; j < 2 + n; ++j) hessian(i, j) = a * g.g1.dd(i, j) + b * g.g2.dd(i, j);
          }
          slots.scale_both(hessian, 2);
        }
        sink.add(
            {.entries = {&actuator.dof, 1}},
            {.controls = slots.controls, .tangent = tangent, .hessian = request.a != nullptr ? &hessian : nullptr});
      }
      return true;
    } else {
      return false;
    }
  }

  void list_limited(std::vector<model::LimitedMuscle>& muscles) const override {
    if constexpr (LimitedElement<Element>) {
      for (const auto& actuator : actuators_) {
        model::LimitedMuscle muscle = limited_muscle(actuator.element, actuator.controls[0]);
        muscle.name = std::string(Element::folder) + "/" + actuator.name;
        muscle.entry = actuator.dof;
        muscles.push_back(std::move(muscle));
      }
    }
  }

  /// As of a TwoPointTerm: what vanishes with the rate dissipates, the rest is a drive.
  model::IntervalWork work(const model::IntervalPoint& at) const override {
    model::IntervalWork total;
    for (const auto& actuator : actuators_) {
      auto s = actuator.state(at.q, at.v, at.u);
      const double rate = std::exchange(s.zd, 0.0);
      const double force = derivatives(actuator, at).f;
      const double drive = Isolated<Element>{actuator.element}.force(s.z, s.zd, s.e);
      total += {.dissipated = at.dt * (drive - force) * rate, .external = at.dt * drive * rate};
    }
    return total;
  }

  std::vector<std::string> parts() const override {
    std::vector<std::string> names;
    for (const auto& actuator : actuators_) names.push_back(std::string(Element::folder) + "/" + actuator.name);
    return names;
  }

  void energies(const model::NodePoint& at, std::span<model::Energy> out) const override {
    for (std::size_t k = 0; k < actuators_.size(); ++k) {
      const auto s = actuators_[k].state(at.q, at.v, at.u);
      const Isolated<Element> element{actuators_[k].element};
      out[k] += {.kinetic = element.kinetic(s.z, s.zd),
                 .elastic = element.elastic(s.z),
                 .electric = element.electric(s.z, s.e)};
    }
  }

  std::string inadmissible(const Eigen::VectorXd& q) const override {
    for (const auto& actuator : actuators_) {
      const std::string why = why_inadmissible(actuator.element, q[actuator.dof]);
      if (!why.empty()) return std::string(Element::noun) + " '" + actuator.name + "': " + why;
    }
    return {};
  }

 private:
  static AxialDerivatives<double, Element::n_controls> derivatives(const FreeActuator<Element>& actuator,
                                                                   const model::IntervalPoint& at) {
    const auto s = actuator.state(at.q, at.v, at.u);
    return axial_derivatives(Isolated<Element>{actuator.element}, s.z, s.zd, s.e);
  }

  std::vector<FreeActuator<Element>> actuators_;
  std::vector<math::BlockSlot> slots_;
};

}  // namespace muldi::muscles
