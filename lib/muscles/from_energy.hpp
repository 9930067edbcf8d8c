#pragma once
/// Derivatives of elements that are given by their energies alone: jets over the twelve point coordinates (thesis 6.4).
#include <Eigen/Core>
#include <cstddef>

#include "math/jet.hpp"
#include "muscles/two_point.hpp"

namespace muldi::muscles {

/// The Lagrangian, the axial force and the length of an element, with derivatives by (a1, a2, v1, v2, e).
template <EnergyElement Element>
struct EnergyJets {
  static constexpr int n_controls = Element::n_controls;
  static constexpr int n = 12 + n_controls;
  using Jet = math::Jet2<n>;

  Jet lagrangian;
  Jet force;
  Jet length;

  EnergyJets(const Element& element, const TwoPoint<double, n_controls>& x) {
    TwoPoint<Jet, n_controls> at;
    for (int r = 0; r < 3; ++r) {
      at.a1(r) = Jet::variable(x.a1(r), r);
      at.a2(r) = Jet::variable(x.a2(r), 3 + r);
      at.v1(r) = Jet::variable(x.v1(r), 6 + r);
      at.v2(r) = Jet::variable(x.v2(r), 9 + r);
    }
    for (int c = 0; c < n_controls; ++c) {
      const auto of = static_cast<std::size_t>(c);
      at.e[of] = Jet::variable(x.e[of], 12 + c);
    }
    lagrangian = element.kinetic(at) - element.elastic(at) - element.electric(at);
    force = element.force(at);
    length = at.length();
  }

  /// Entry `row` < 6 of d(f dz/da)/dx_column.
  double force_slope(int row, int column) const {
    return force.d(column) * length.d(row) + force.value * length.dd(row, column);
  }
};

template <EnergyElement Element>
void point_forces(const Element& element, const TwoPoint<double, Element::n_controls>& x, PointForces& out) {
  const EnergyJets<Element> jets(element, x);
  for (int r = 0; r < 6; ++r) {
    out.force(r) = jets.lagrangian.d(r) + jets.force.value * jets.length.d(r);
    out.momentum(r) = jets.lagrangian.d(6 + r);
  }
}

template <EnergyElement Element>
void point_tangent(const Element& element, const TwoPoint<double, Element::n_controls>& x,
                   const model::TangentWeights& weights, Matrix6& out) {
  const EnergyJets<Element> jets(element, x);
  const auto& l = jets.lagrangian;
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) {
      out(r, c) = weights.vv * l.dd(6 + r, 6 + c) + weights.vq * l.dd(6 + r, c) +
                  weights.qv * (l.dd(r, 6 + c) + jets.force_slope(r, 6 + c)) +
                  weights.qq * (l.dd(r, c) + jets.force_slope(r, c));
    }
  }
}

template <EnergyElement Element>
Vector6 point_control_force(const Element& element, const TwoPoint<double, Element::n_controls>& x, int control) {
  const EnergyJets<Element> jets(element, x);
  Vector6 out;
  for (int r = 0; r < 6; ++r) out(r) = jets.lagrangian.dd(r, 12 + control) + jets.force_slope(r, 12 + control);
  return out;
}

/// Force with which the first end is pulled to the second, inertia apart; > 0 in tension.
template <EnergyElement Element>
double pull(const Element& element, const TwoPoint<double, Element::n_controls>& x) {
  auto rest = x;
  rest.v1.setZero();
  rest.v2.setZero();
  const EnergyJets jets(element, rest);
  const Line line(x);
  double along = 0.0;
  for (int r = 0; r < 3; ++r) along += jets.lagrangian.d(r) * line.n(r);
  return 0.0 - along - element.force(x);
}

}  // namespace muldi::muscles
