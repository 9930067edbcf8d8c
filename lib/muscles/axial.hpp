#pragma once
/// Elements that act along the line between their two ends: scalar functions of the length z and its rate.
#include <array>
#include <concepts>
#include <cstddef>

#include "math/jet.hpp"

namespace muldi::muscles {

/// Values of an element's controls, in the element's own units.
template <class S, int n>
using Controls = std::array<S, static_cast<std::size_t>(n)>;

/// Derivatives of the axial Lagrangian l(z, zd; e) = kinetic - elastic - electric and of the axial force f(z, zd; e).
template <class S, int n_controls>
struct AxialDerivatives {
  S l_z{};
  S l_d{};  ///< by the rate zd
  S l_zz{};
  S l_zd{};
  S l_dd{};
  S f{};
  S f_z{};
  S f_d{};
  Controls<S, n_controls> h_e{};  ///< d(l_z + f)/de
};

/// Mass matrix of the two ends, [[m11, m12], [m12, m22]] (x) 1_3; constant.
struct EndMass {
  double m11 = 0.0;
  double m12 = 0.0;
  double m22 = 0.0;
};

/// What an element of the fast path provides. Functions are templates of the scalar: double, a jet or a dual.
///
///     static constexpr int n_controls;
///     static constexpr std::string_view folder, noun;  // of results and of messages: "muscles", "muscle"
///     double mass() const;                             // weight, half at each end
///     EndMass end_mass() const;                        // inertia beside the axial one
///     S kinetic(z, zd), elastic(z), electric(z, e), force(z, zd, e);
///     AxialDerivatives axial(z, zd, e);                // optional, by hand; else by jets
///     std::string inadmissible(double z);              // empty if the length is admissible
template <class E>
concept AxialElement = requires(const E& element, double z, const Controls<double, E::n_controls>& e) {
  { element.end_mass() } -> std::same_as<EndMass>;
  { element.kinetic(z, z) } -> std::convertible_to<double>;
  { element.elastic(z) } -> std::convertible_to<double>;
  { element.electric(z, e) } -> std::convertible_to<double>;
  { element.force(z, z, e) } -> std::convertible_to<double>;
};

/// The derivatives by second-order jets over (z, zd, e): the referee of a hand-written `axial`, and its stand-in.
template <AxialElement Element, class S = double>
AxialDerivatives<S, Element::n_controls> axial_by_jets(const Element& element, const S& z, const S& zd,
                                                       const Controls<S, Element::n_controls>& e) {
  constexpr int n = 2 + Element::n_controls;
  using Jet = math::Jet2<n, S>;
  const Jet z_jet = Jet::variable(z, 0);
  const Jet d_jet = Jet::variable(zd, 1);
  Controls<Jet, Element::n_controls> e_jet;
  for (int c = 0; c < Element::n_controls; ++c) {
    const auto at = static_cast<std::size_t>(c);
    e_jet[at] = Jet::variable(e[at], 2 + c);
  }
  const Jet l = element.kinetic(z_jet, d_jet) - element.elastic(z_jet) - element.electric(z_jet, e_jet);
  const Jet f = element.force(z_jet, d_jet, e_jet);
  AxialDerivatives<S, Element::n_controls> out{.l_z = l.d(0),
                                               .l_d = l.d(1),
                                               .l_zz = l.dd(0, 0),
                                               .l_zd = l.dd(0, 1),
                                               .l_dd = l.dd(1, 1),
                                               .f = f.value,
                                               .f_z = f.d(0),
                                               .f_d = f.d(1)};
  for (int c = 0; c < Element::n_controls; ++c) {
    out.h_e[static_cast<std::size_t>(c)] = l.dd(0, 2 + c) + f.d(2 + c);
  }
  return out;
}

/// By hand where the element has it, else by jets.
template <AxialElement Element, class S = double>
AxialDerivatives<S, Element::n_controls> axial_derivatives(const Element& element, const S& z, const S& zd,
                                                           const Controls<S, Element::n_controls>& e) {
  if constexpr (requires { element.axial(z, zd, e); }) {
    return element.axial(z, zd, e);
  } else {
    return axial_by_jets(element, z, zd, e);
  }
}

}  // namespace muldi::muscles
