#pragma once
/// Second-order expansion of an element of the fast path: the derivatives of its forces and of Psi = a.F + b.pi by the
/// vector r = a1 - a2 between its ends, its rate w, and the controls.
///
/// With g1 = dl/dz + f and g2 = dl/dzd as functions of (z, zd, e), and the line z = |r|, zd = n.w, the forces are
/// F = g1 n + g2 t and pi = g2 n, and Psi = g1 z' + g2 d' with the derivatives z' = n.a, d' = t.a + n.b of z and zd
/// along (a, b): second derivatives of g1 and g2 come from dual numbers, those of the four functions of the line from
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

/// g1 and g2 with their derivatives by (z, zd, e): first ones from the element's second derivatives, second ones, if
/// wanted, from dual numbers through these. `n_variables`: 2 leaves the controls out.
template <int n_variables, AxialElement Element>
AxialForces<n_variables> axial_forces(const Element& element, double z, double zd,
                                      const Controls<double, Element::n_controls>& e, bool second) {
  constexpr bool with_controls = n_variables > 2;
  AxialForces<n_variables> g;
  const auto d = axial_derivatives(element, z, zd, e);
  g.g1.value = d.l_z + d.f;
  g.g2.value = d.l_d;
  g.g1.gradient[0] = d.l_zz + d.f_z;
  g.g1.gradient[1] = d.l_zd + d.f_d;
  g.g2.gradient[0] = d.l_zd;
  g.g2.gradient[1] = d.l_dd;
  if constexpr (with_controls) {
    for (std::size_t c = 0; c < e.size(); ++c) g.g1.gradient[2 + c] = d.h_e[c];
  }
  if (!second) return g;
  using Along = math::Dual<double>;
  for (std::size_t i = 0; i < static_cast<std::size_t>(n_variables); ++i) {
    Controls<Along, Element::n_controls> seeds;
    for (std::size_t c = 0; c < e.size(); ++c) seeds[c] = Along(e[c], i == 2 + c ? 1.0 : 0.0);
    const auto s = axial_derivatives(element, Along(z, i == 0 ? 1.0 : 0.0), Along(zd, i == 1 ? 1.0 : 0.0), seeds);
    // Row i of the lower triangle.
    const std::size_t row = i * (i + 1) / 2;
    g.g1.hessian[row] = s.l_zz.slope + s.f_z.slope;
    g.g2.hessian[row] = s.l_zd.slope;
    if (i == 0) continue;
    g.g1.hessian[row + 1] = s.l_zd.slope + s.f_d.slope;
    g.g2.hessian[row + 1] = s.l_dd.slope;
    if constexpr (with_controls) {
      for (std::size_t c = 0; 2 + c <= i; ++c) g.g1.hessian[row + 2 + c] = s.h_e[c].slope;
    }
  }
  return g;
}

/// to += factor from, of the variables (z, zd).
template <int n>
void add_share(const math::Jet2<2>& from, double factor, math::Jet2<n>& to) {
  to.value += factor * from.value;
  for (std::size_t i = 0; i < 2; ++i) to.gradient[i] += factor * from.gradient[i];
  for (std::size_t k = 0; k < 3; ++k) to.hessian[k] += factor * from.hessian[k];
}

/// The derivatives by a variable of which `slope` is the factor.
template <int n>
void add_variable(const math::Jet2<2>& slope, int variable, math::Jet2<n>& to) {
  const auto v = static_cast<std::size_t>(variable);
  to.gradient[v] += slope.value;
  to.hessian[v * (v + 1) / 2] += slope.gradient[0];
  to.hessian[v * (v + 1) / 2 + 1] += slope.gradient[1];
}

/// Forces affine in every e_c^2: g = g(0) + sum_c e_c^2 (g(reference_c) - g(0))/reference_c^2, whose derivatives by
/// e_c^2 are finite at 0.
// NOLINTBEGIN(readability-function-size): where it is expanded takes four of the six.
template <AxialElement Element>
AxialForces<2 + Element::n_controls> squared_axial_forces(const Element& element, double z, double zd,
                                                          const Controls<double, Element::n_controls>& e,
                                                          const SquaredControls<Element::n_controls>& reference,
                                                          bool second) {
  Controls<double, Element::n_controls> at{};
  const AxialForces<2> none = axial_forces<2>(element, z, zd, at, second);
  AxialForces<2 + Element::n_controls> sum;
  add_share(none.g1, 1.0, sum.g1);
  add_share(none.g2, 1.0, sum.g2);
  for (int c = 0; c < Element::n_controls; ++c) {
    const auto of = static_cast<std::size_t>(c);
    at = {};
    at[of] = reference[of];
    AxialForces<2> share = axial_forces<2>(element, z, zd, at, second);
    const double factor = 1.0 / (reference[of] * reference[of]);
    share.g1 -= none.g1;
    share.g1 *= factor;
    share.g2 -= none.g2;
    share.g2 *= factor;
    add_share(share.g1, e[of] * e[of], sum.g1);
    add_share(share.g2, e[of] * e[of], sum.g2);
    add_variable(share.g1, 2 + c, sum.g1);
    add_variable(share.g2, 2 + c, sum.g2);
  }
  return sum;
}
// NOLINTEND(readability-function-size)

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
