#pragma once
/// Second-order expansion of an element of the fast path: the derivatives of its forces and of Psi = a.F + b.pi by the
/// vector r = a1 - a2 between its ends, its rate w, and the controls.
///
/// With g1 = dl/dz + f and g2 = dl/dzd as functions of (z, zd, e), and the line z = |r|, zd = n.w, the forces are
/// F = g1 n + g2 t and pi = g2 n, and Psi = g1 z' + g2 d' with the derivatives z' = n.a, d' = t.a + n.b of z and zd
/// along (a, b): second derivatives of g1 and g2 come from jets, those of the four functions of the line from
///
///     P = (1 - n n^T)/z = dn/dr,   S(a) = d(P a)/dr = -(n (P a)^T + (P a) n^T + (n.a) P)/z
///
/// and d(S(a) w)/dr.
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "muscles/two_point.hpp"

namespace muldi::muscles {

/// g1 = l_z + f and g2 = l_d with derivatives by (z, zd, s).
template <int n>
struct AxialForces {
  math::Jet2<n> g1;
  math::Jet2<n> g2;
};

/// Where the element takes derivatives by e^2 instead of e: reference values of e, 0 for plain controls.
template <int n_controls>
using SquaredControls = Controls<double, n_controls>;

/// Jets over (z, zd, e); controls that count by their square enter as constants.
template <AxialElement Element>
AxialForces<2 + Element::n_controls> plain_axial_forces(const Element& element, double z, double zd,
                                                        const Controls<double, Element::n_controls>& e) {
  constexpr int n = 2 + Element::n_controls;
  using Jet = math::Jet2<n>;
  Controls<Jet, Element::n_controls> seeds;
  for (int c = 0; c < Element::n_controls; ++c) {
    const auto at = static_cast<std::size_t>(c);
    seeds[at] = Jet::variable(e[at], 2 + c);
  }
  const auto d = axial_derivatives(element, Jet::variable(z, 0), Jet::variable(zd, 1), seeds);
  return {d.l_z + d.f, d.l_d};
}

/// Forces affine in every e_c^2: g = g(0) + sum_c e_c^2 (g(reference_c) - g(0))/reference_c^2, whose derivatives by
/// e_c^2 are finite at 0.
template <AxialElement Element>
AxialForces<2 + Element::n_controls> squared_axial_forces(const Element& element, double z, double zd,
                                                          const Controls<double, Element::n_controls>& e,
                                                          const SquaredControls<Element::n_controls>& reference) {
  using Small = math::Jet2<2>;
  using Jet = math::Jet2<2 + Element::n_controls>;
  const auto forces_at = [&](const Controls<double, Element::n_controls>& value) {
    Controls<Small, Element::n_controls> constants;
    for (std::size_t c = 0; c < value.size(); ++c) constants[c] = Small(value[c]);
    const auto d = axial_derivatives(element, Small::variable(z, 0), Small::variable(zd, 1), constants);
    return AxialForces<2>{d.l_z + d.f, d.l_d};
  };
  const auto widen = [](const Small& from, double factor, Jet& to) {
    to.value += factor * from.value;
    for (std::size_t i = 0; i < 2; ++i) to.gradient[i] += factor * from.gradient[i];
    for (std::size_t k = 0; k < 3; ++k) to.hessian[k] += factor * from.hessian[k];
  };
  const auto by_square = [](const Small& from, int variable, Jet& to) {
    to.gradient[static_cast<std::size_t>(variable)] += from.value;
    const std::size_t row = static_cast<std::size_t>(variable) * static_cast<std::size_t>(variable + 1) / 2;
    to.hessian[row] += from.gradient[0];
    to.hessian[row + 1] += from.gradient[1];
  };
  Controls<double, Element::n_controls> at{};
  const AxialForces<2> none = forces_at(at);
  AxialForces<2 + Element::n_controls> sum;
  widen(none.g1, 1.0, sum.g1);
  widen(none.g2, 1.0, sum.g2);
  for (int c = 0; c < Element::n_controls; ++c) {
    const auto of = static_cast<std::size_t>(c);
    at = {};
    at[of] = reference[of];
    AxialForces<2> share = forces_at(at);
    const double factor = 1.0 / (reference[of] * reference[of]);
    share.g1 -= none.g1;
    share.g1 *= factor;
    share.g2 -= none.g2;
    share.g2 *= factor;
    widen(share.g1, e[of] * e[of], sum.g1);
    widen(share.g2, e[of] * e[of], sum.g2);
    by_square(share.g1, 2 + c, sum.g1);
    by_square(share.g2, 2 + c, sum.g2);
  }
  return sum;
}

/// The vectors that the expansion starts from.
struct RelativeState {
  Eigen::Vector3d r;
  Eigen::Vector3d w;
  Eigen::Vector3d a = Eigen::Vector3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
};

/// Functions of the line between the ends and their derivatives.
struct LineExpansion {
  using Matrix3 = Eigen::Matrix3d;
  double z, zd, z_a, d_ab;  // z, zd and their derivatives z', d' along (a, b)
  Eigen::Vector3d n, t, pa, d_r;
  Matrix3 P, S_w, S_a, Q;  // second derivatives of z, zd, z', d' by r

  explicit LineExpansion(const RelativeState& x) {
    z = x.r.norm();
    n = x.r / z;
    P = (Matrix3::Identity() - n * n.transpose()) / z;
    t = P * x.w;
    zd = n.dot(x.w);
    S_w = bend(t, zd);
    pa = P * x.a;
    z_a = n.dot(x.a);
    S_a = bend(pa, z_a);
    d_ab = t.dot(x.a) + n.dot(x.b);
    const Eigen::Vector3d s = S_a * x.w;
    d_r = s + P * x.b;
    // d(S(a) w)/dr, and S(b) for the part n.b.
    Q = -(pa.dot(x.w) * P + n * s.transpose() + s * n.transpose() + zd * S_a + pa * t.transpose() + t * pa.transpose() +
          z_a * S_w) /
            z +
        bend(P * x.b, n.dot(x.b));
  }

 private:
  Matrix3 bend(const Eigen::Vector3d& p, double along) const {
    return -(n * p.transpose() + p * n.transpose() + along * P) / z;
  }
};

/// d(F, pi)/d(r, w, s) of one element, (6, 6 + n_controls).
template <int n_controls>
void relative_tangent(const LineExpansion& line, const AxialForces<2 + n_controls>& g, Eigen::MatrixXd& out) {
  const auto& n = line.n;
  const auto& t = line.t;
  const Eigen::Vector3d g1_r = g.g1.d(0) * n + g.g1.d(1) * t;
  const Eigen::Vector3d g2_r = g.g2.d(0) * n + g.g2.d(1) * t;
  out.topLeftCorner<3, 3>() = n * g1_r.transpose() + t * g2_r.transpose() + g.g1.value * line.P + g.g2.value * line.S_w;
  out.block<3, 3>(0, 3) = (g.g1.d(1) * n + g.g2.d(1) * t) * n.transpose() + g.g2.value * line.P;
  out.block<3, 3>(3, 0) = n * g2_r.transpose() + g.g2.value * line.P;
  out.block<3, 3>(3, 3) = g.g2.d(1) * n * n.transpose();
  for (int c = 0; c < n_controls; ++c) {
    out.block<3, 1>(0, 6 + c) = g.g1.d(2 + c) * n + g.g2.d(2 + c) * t;
    out.block<3, 1>(3, 6 + c) = g.g2.d(2 + c) * n;
  }
}

/// d2 Psi/d(r, w, s)2 of one element, (6 + n_controls, 6 + n_controls).
template <int n_controls>
void relative_hessian(const LineExpansion& line, const AxialForces<2 + n_controls>& g, Eigen::MatrixXd& out) {
  constexpr int n_y = 6 + n_controls;
  constexpr int n_g = 2 + n_controls;
  using Row = Eigen::Matrix<double, 1, n_y>;
  // Gradients of (z, zd, s) and of z', d' by y.
  Eigen::Matrix<double, n_g, n_y> G = Eigen::Matrix<double, n_g, n_y>::Zero();
  G.template block<1, 3>(0, 0) = line.n.transpose();
  G.template block<1, 3>(1, 0) = line.t.transpose();
  G.template block<1, 3>(1, 3) = line.n.transpose();
  for (int c = 0; c < n_controls; ++c) G(2 + c, 6 + c) = 1.0;
  Row z_y = Row::Zero();
  Row d_y = Row::Zero();
  z_y.template head<3>() = line.pa.transpose();
  d_y.template head<3>() = line.d_r.transpose();
  d_y.template segment<3>(3) = line.pa.transpose();
  Eigen::Matrix<double, n_g, n_g> inner;
  Row g1_y = Row::Zero();
  Row g2_y = Row::Zero();
  for (int i = 0; i < n_g; ++i) {
    for (int j = 0; j < n_g; ++j) inner(i, j) = g.g1.dd(i, j) * line.z_a + g.g2.dd(i, j) * line.d_ab;
    g1_y += g.g1.d(i) * G.row(i);
    g2_y += g.g2.d(i) * G.row(i);
  }
  out.noalias() = G.transpose() * (inner * G);
  out += g1_y.transpose() * z_y + z_y.transpose() * g1_y + g2_y.transpose() * d_y + d_y.transpose() * g2_y;
  const double by_z = g.g1.d(0) * line.z_a + g.g2.d(0) * line.d_ab;
  const double by_d = g.g1.d(1) * line.z_a + g.g2.d(1) * line.d_ab;
  out.topLeftCorner<3, 3>() += by_z * line.P + by_d * line.S_w + g.g1.value * line.S_a + g.g2.value * line.Q;
  const Eigen::Matrix3d rw = by_d * line.P + g.g2.value * line.S_a;
  out.block<3, 3>(0, 3) += rw;
  out.block<3, 3>(3, 0) += rw;
}

}  // namespace muldi::muscles
