#pragma once
/// Elements between two points (thesis 6.4): what an element may be, and its derivatives by the twelve coordinates.
///
/// There are two kinds. An AxialElement (muscles/axial.hpp) has constant end masses and scalar functions of the length;
/// the chain rule to the points is written by hand: the fast path. An EnergyElement gives its functions of the whole
/// TwoPoint, in any dependence; its derivatives come from jets over the twelve coordinates:
///
///     struct Research {
///       static constexpr int n_controls = 1;
///       static constexpr std::string_view folder = "muscles", noun = "muscle";
///       double mass() const;                                          // weight, half at each end; 0 without
///       template <class S> S kinetic(const TwoPoint<S, 1>& x) const;
///       template <class S> S elastic(const TwoPoint<S, 1>& x) const;
///       template <class S> S electric(const TwoPoint<S, 1>& x) const;
///       template <class S> S force(const TwoPoint<S, 1>& x) const;    // on the length: virtual work f dz
///       bool dissipates() const;                                      // whether the force depends on velocities
///     };
///
/// and, if it has them, inadmissible, advice and observe as an AxialElement.
///
/// Kinetic energies do not depend on controls.
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <string_view>

#include "math/jet.hpp"
#include "math/jet_eigen.hpp"
#include "model/interval_term.hpp"
#include "muscles/axial.hpp"

namespace muldi::muscles {

template <class S>
using Vector3 = Eigen::Matrix<S, 3, 1>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// The state of an element: its ends, their velocities, its controls, and what derives from them.
template <class S, int n_controls>
struct TwoPoint {
  Vector3<S> a1, a2;  ///< ends
  Vector3<S> v1, v2;  ///< their velocities
  Controls<S, n_controls> e{};

  /// z = |a1 - a2|.
  S length() const {
    using std::sqrt;
    const Vector3<S> r = a1 - a2;
    return sqrt(S(r.dot(r)));
  }
  /// zd = n . (v1 - v2), n = (a1 - a2)/z.
  S rate() const {
    const Vector3<S> r = a1 - a2;
    const Vector3<S> w = v1 - v2;
    return S(r.dot(w)) / length();
  }
  Vector3<S> midpoint() const { return 0.5 * (a1 + a2); }
  Vector3<S> mid_velocity() const { return 0.5 * (v1 + v2); }
};

/// An element given by functions of the whole state.
template <class E>
concept EnergyElement = requires(const E& element, const TwoPoint<double, E::n_controls>& x) {
  { element.kinetic(x) } -> std::convertible_to<double>;
  { element.elastic(x) } -> std::convertible_to<double>;
  { element.electric(x) } -> std::convertible_to<double>;
  { element.force(x) } -> std::convertible_to<double>;
  { element.dissipates() } -> std::convertible_to<bool>;
};

template <class E>
concept TwoPointElement = AxialElement<E> || EnergyElement<E>;

/// dL/da + f and dL/dv of both ends: rows 0-2 of the first, 3-5 of the second.
struct PointForces {
  Vector6 force = Vector6::Zero();
  Vector6 momentum = Vector6::Zero();
};

/// The line between the ends: z, n, zd and t = (w - zd n)/z, the turning rate of n. Then dz = n.dr, dzd = t.dr + n.dw.
struct Line {
  double z = 0.0;
  double zd = 0.0;
  Eigen::Vector3d n;
  Eigen::Vector3d t;

  template <int n_controls>
  explicit Line(const TwoPoint<double, n_controls>& x) {
    const Eigen::Vector3d r = x.a1 - x.a2;
    const Eigen::Vector3d w = x.v1 - x.v2;
    z = r.norm();
    n = Eigen::Vector3d::UnitX();
    if (z > shortest) {
      n = r / z;
    } else {
      z = shortest;
    }
    zd = n.dot(w);
    t = (w - zd * n) / z;
  }

 private:
  // A spring without rest length is smooth at z = 0: any direction gives its stiffness there.
  static constexpr double shortest = 1e-100;
};

/// Forces of an element of the fast path.
template <AxialElement Element>
void point_forces(const Element& element, const TwoPoint<double, Element::n_controls>& x, PointForces& out) {
  const Line line(x);
  const auto d = axial_derivatives(element, line.z, line.zd, x.e);
  const Eigen::Vector3d force = (d.l_z + d.f) * line.n + d.l_d * line.t;
  const Eigen::Vector3d momentum = d.l_d * line.n;
  const EndMass m = end_mass_of(element);
  out.force << force, -force;
  out.momentum << momentum + m.m11 * x.v1 + m.m12 * x.v2, -momentum + m.m12 * x.v1 + m.m22 * x.v2;
}

/// Weighted second derivatives of an element of the fast path (6, 6), see TangentWeights.
///
/// With P = (1 - n n^T)/z: dn/dr = P and dt/dr = -(t n^T + n t^T + zd P)/z, so that every block of the axial part is a
/// combination of n n^T, n t^T, t n^T, t t^T and P.
template <AxialElement Element>
void point_tangent(const Element& element, const TwoPoint<double, Element::n_controls>& x,
                   const model::TangentWeights& weights, Matrix6& out) {
  const Line line(x);
  const auto d = axial_derivatives(element, line.z, line.zd, x.e);
  const auto [vv, vq, qv, qq] = weights;
  const double i = 1.0 / line.z;
  const double turning = d.l_zd - d.l_d * i;
  const double p = i * ((vq + qv) * d.l_d + qq * (d.l_z + d.f - line.zd * i * d.l_d));
  const double nn = vv * d.l_dd + vq * d.l_zd + qv * (d.l_zd + d.f_d) + qq * (d.l_zz + d.f_z) - p;
  const double nt = vq * d.l_dd + qq * (turning + d.f_d);
  const double tn = qv * d.l_dd + qq * turning;
  const double tt = qq * d.l_dd;
  // Row r of the block is n_r (nn n + nt t) + t_r (tn n + tt t) + p e_r.
  const Eigen::Vector3d along = nn * line.n + nt * line.t;
  const Eigen::Vector3d across = tn * line.n + tt * line.t;
  Eigen::Matrix3d axial = line.n * along.transpose() + line.t * across.transpose();
  axial.diagonal().array() += p;
  const EndMass m = end_mass_of(element);
  out.topLeftCorner<3, 3>() = axial;
  out.topRightCorner<3, 3>() = -axial;
  out.bottomLeftCorner<3, 3>() = -axial;
  out.bottomRightCorner<3, 3>() = axial;
  out.diagonal().head<3>().array() += vv * m.m11;
  out.diagonal().tail<3>().array() += vv * m.m22;
  for (int r = 0; r < 3; ++r) {
    out(r, 3 + r) += vv * m.m12;
    out(3 + r, r) += vv * m.m12;
  }
}

/// d(dL/da + f)/de of control `control` of the element (6).
template <AxialElement Element>
Vector6 point_control_force(const Element& element, const TwoPoint<double, Element::n_controls>& x, int control) {
  const Line line(x);
  const auto d = axial_derivatives(element, line.z, line.zd, x.e);
  const Eigen::Vector3d force = d.h_e[static_cast<std::size_t>(control)] * line.n;
  Vector6 out;
  out << force, -force;
  return out;
}

/// Force with which the element pulls its ends together, inertia apart; > 0 in tension.
template <AxialElement Element>
double pull(const Element& element, const TwoPoint<double, Element::n_controls>& x) {
  const Line line(x);
  return pull(element, AxialState<Element::n_controls>{line.z, line.zd, x.e});
}

/// An element of the fast path as an EnergyElement: the readable formula, and the referee of the fast path.
template <AxialElement Element>
struct FromAxial {
  static constexpr int n_controls = Element::n_controls;
  static constexpr std::string_view folder = Element::folder;
  static constexpr std::string_view noun = Element::noun;

  Element element;

  double mass() const { return mass_of(element); }
  template <class S>
  S kinetic(const TwoPoint<S, n_controls>& x) const {
    const EndMass m = end_mass_of(element);
    return 0.5 * (m.m11 * S(x.v1.dot(x.v1)) + m.m22 * S(x.v2.dot(x.v2))) + m.m12 * S(x.v1.dot(x.v2)) +
           kinetic_energy(element, x.length(), x.rate());
  }
  template <class S>
  S elastic(const TwoPoint<S, n_controls>& x) const {
    return element.elastic(x.length());
  }
  template <class S>
  S electric(const TwoPoint<S, n_controls>& x) const {
    return electric_energy(element, x.length(), x.e);
  }
  template <class S>
  S force(const TwoPoint<S, n_controls>& x) const {
    return element.force(x.length(), x.rate(), x.e);
  }
  bool dissipates() const { return element.dissipates(); }
};

/// Either kind of element as an EnergyElement.
template <TwoPointElement Element>
auto as_energy(const Element& element) {
  if constexpr (AxialElement<Element>) {
    return FromAxial<Element>{element};
  } else {
    return element;
  }
}

}  // namespace muldi::muscles
