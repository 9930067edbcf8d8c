#pragma once
/// All elements of one type between two points, as one interval term.
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "model/interval_term.hpp"
#include "model/linear_point.hpp"
#include "muscles/axial_expansion.hpp"
#include "muscles/control_input.hpp"
#include "muscles/from_energy.hpp"
#include "muscles/point_scatter.hpp"
#include "muscles/two_point.hpp"

namespace muldi::muscles {

/// One named element with its ends.
template <TwoPointElement Element>
struct TwoPointComponent {
  std::string name;
  Element element;
  model::LinearPoint a1;
  model::LinearPoint a2;
  std::array<ControlInput, static_cast<std::size_t>(Element::n_controls)> controls{};

  /// The state at configuration q, velocity v and controls u.
  TwoPoint<double, Element::n_controls> state(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                              std::span<const double> u) const {
    TwoPoint<double, Element::n_controls> x{a1.value(q), a2.value(q), a1.rate(v), a2.rate(v)};
    for (std::size_t c = 0; c < controls.size(); ++c) x.e[c] = controls[c].value(u);
    return x;
  }
};

template <TwoPointElement Element>
class TwoPointTerm final : public model::IntervalTerm {
 public:
  using Component = TwoPointComponent<Element>;

  /// `gravity` (3): acceleration; acts on half the element's mass at each end, potential -m g.(a1 + a2)/2.
  TwoPointTerm(std::vector<Component> components, const Eigen::Vector3d& gravity)
      : components_(std::move(components)), gravity_(gravity) {
    for (const Component& component : components_) scatters_.emplace_back(component.a1, component.a2);
  }

  const std::vector<Component>& components() const { return components_; }

  void request(model::PatternRequest& pattern) const override {
    for (const PointScatter& scatter : scatters_) scatter.request(pattern);
  }
  void bind(const math::BlockPattern& pattern) override {
    for (PointScatter& scatter : scatters_) scatter.bind(pattern);
  }

  void add_forces(const model::IntervalPoint& at, model::IntervalForces& out) const override {
    PointForces forces;
    for (const Component& component : components_) {
      point_forces(component.element, component.state(at.q, at.v, at.u), forces);
      const Eigen::Vector3d weight = 0.5 * mass_of(component.element) * gravity_;
      component.a1.add_transposed(forces.force.template head<3>() + weight, out.force);
      component.a2.add_transposed(forces.force.template tail<3>() + weight, out.force);
      component.a1.add_transposed(forces.momentum.template head<3>(), out.momentum);
      component.a2.add_transposed(forces.momentum.template tail<3>(), out.momentum);
    }
  }

  void add_tangent(const model::IntervalPoint& at, const model::TangentWeights& weights,
                   math::BlockMatrix& K) const override {
    Matrix6 tangent;
    for (std::size_t k = 0; k < components_.size(); ++k) {
      point_tangent(components_[k].element, components_[k].state(at.q, at.v, at.u), weights, tangent);
      scatters_[k].add(tangent, K);
    }
  }

  void add_control_force(const model::IntervalPoint& at, int control, Eigen::VectorXd& out) const override {
    for (const Component& component : components_) {
      for (int c = 0; c < Element::n_controls; ++c) {
        const ControlInput& input = component.controls[static_cast<std::size_t>(c)];
        if (input.control != control) continue;
        const Vector6 slope =
            input.factor * point_control_force(component.element, component.state(at.q, at.v, at.u), c);
        component.a1.add_transposed(slope.head<3>(), out);
        component.a2.add_transposed(slope.tail<3>(), out);
      }
    }
  }

  void add_constant_mass(std::vector<model::MassEntry>& mass) const override {
    if constexpr (AxialElement<Element>) {
      for (const Component& component : components_) {
        const EndMass m = end_mass_of(component.element);
        if (m.m11 == 0.0 && m.m12 == 0.0 && m.m22 == 0.0) continue;
        mass.push_back({component.a1, component.a1, m.m11});
        mass.push_back({component.a1, component.a2, m.m12});
        mass.push_back({component.a2, component.a1, m.m12});
        mass.push_back({component.a2, component.a2, m.m22});
      }
    }
  }

  /// Elements of the fast path depend on the vector between their ends. Others have no such expansion.
  bool expand(const model::IntervalPoint& at, const model::ExpansionRequest& request,
              model::ExpansionSink& sink) const override {
    if constexpr (AxialElement<Element>) {
      constexpr int n = Element::n_controls;
      Eigen::MatrixXd tangent(6, 6 + n);
      Eigen::MatrixXd hessian(6 + n, 6 + n);
      for (const Component& component : components_) {
        const auto x = component.state(at.q, at.v, at.u);
        RelativeState relative{.r = x.a1 - x.a2, .w = x.v1 - x.v2};
        if (request.a != nullptr) {
          relative.a = component.a1.rate(*request.a) - component.a2.rate(*request.a);
          relative.b = component.a1.rate(*request.b) - component.a2.rate(*request.b);
        }
        const LineExpansion line(relative);
        const ControlSlots<n> slots(component.controls, request.squared);
        const AxialForces<2 + n> g = slots.axial_forces(component.element, line.z, line.zd, x.e, request.a != nullptr);
        relative_tangent<n>(line, g, tangent);
        if (request.a != nullptr) relative_hessian<n>(line, g, hessian);
        slots.scale(tangent, 6);
        if (request.a != nullptr) slots.scale_both(hessian, 6);
        const model::LinearPoint between = component.a1 - component.a2;
        sink.add(
            {.points = {&between, 1}},
            {.controls = slots.controls, .tangent = tangent, .hessian = request.a != nullptr ? &hessian : nullptr});
      }
      return true;
    } else {
      return false;
    }
  }

  void list_limited(std::vector<model::LimitedMuscle>& muscles) const override {
    if constexpr (LimitedElement<Element>) {
      for (const Component& component : components_) {
        model::LimitedMuscle muscle = limited_muscle(component.element, component.controls[0]);
        muscle.name = std::string(Element::folder) + "/" + component.name;
        muscle.ends = {component.a1, component.a2};
        muscles.push_back(std::move(muscle));
      }
    }
  }

  /// The part of the axial force that vanishes with the velocities dissipates, the rest is a drive.
  model::IntervalWork work(const model::IntervalPoint& at) const override {
    model::IntervalWork total;
    for (const Component& component : components_) {
      auto x = component.state(at.q, at.v, at.u);
      const auto energy = as_energy(component.element);
      const double travel = at.dt * Line(x).zd;
      const double force = energy.force(x);
      x.v1.setZero();
      x.v2.setZero();
      const double drive = energy.force(x);
      total += {.dissipated = (drive - force) * travel, .external = drive * travel};
    }
    return total;
  }

  std::vector<std::string> parts() const override {
    std::vector<std::string> names;
    for (const Component& component : components_) names.push_back(std::string(Element::folder) + "/" + component.name);
    return names;
  }

  void energies(const model::NodePoint& at, std::span<model::Energy> out) const override {
    for (std::size_t k = 0; k < components_.size(); ++k) {
      const auto x = components_[k].state(at.q, at.v, at.u);
      const auto energy = as_energy(components_[k].element);
      out[k] += {.kinetic = energy.kinetic(x),
                 .elastic = energy.elastic(x),
                 .electric = energy.electric(x),
                 .gravity = -mass_of(components_[k].element) * gravity_.dot(x.midpoint())};
    }
  }

  std::string advice(const model::NodePoint& at) const override {
    if constexpr (requires(const Component& c) { c.element.advice(1.0, 0.0, c.state(at.q, at.v, at.u).e); }) {
      for (const Component& component : components_) {
        const auto x = component.state(at.q, at.v, at.u);
        const std::string why = component.element.advice(x.length(), x.rate(), x.e);
        if (!why.empty()) return std::string(Element::noun) + " '" + component.name + "': " + why;
      }
    }
    return {};
  }

  std::string inadmissible(const Eigen::VectorXd& q) const override {
    for (const Component& component : components_) {
      const double length = (component.a1.value(q) - component.a2.value(q)).norm();
      const std::string why = why_inadmissible(component.element, length);
      if (!why.empty()) return std::string(Element::noun) + " '" + component.name + "': " + why;
    }
    return {};
  }

 private:
  std::vector<Component> components_;
  std::vector<PointScatter> scatters_;
  Eigen::Vector3d gravity_;
};

}  // namespace muldi::muscles
