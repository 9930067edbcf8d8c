#pragma once
/// Elements that act along the line between their two ends: scalar functions of the length z and its rate.
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <string>

#include "math/jet.hpp"

namespace muldi::muscles {

/// Values of an element's controls, in the element's own units.
template <class S, int n>
using Controls = std::array<S, static_cast<std::size_t>(n)>;

/// Length, its rate and the controls at a node in time: what an element's recorded quantities are functions of.
template <int n>
struct AxialState {
  double z = 0.0;
  double zd = 0.0;
  Controls<double, n> e{};
};

/// The whole state of an element that is no function of its length alone (muscles/two_point.hpp). Headers of components
/// need no more than this name, so that the reader of scenes does without matrices.
template <class S, int n_controls>
struct TwoPoint;

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

/// What an element of the fast path provides. Functions are templates of the scalar: double, a jet, a dual, a complex
/// number; branches ask math::number.
///
///     static constexpr int n_controls;
///     static constexpr std::string_view folder, noun;  // of results and of messages: "muscles", "muscle"
///     S elastic(z), force(z, zd, e);                   // potential energy; force on the length, virtual work f dz
///     bool dissipates() const;                         // whether the force depends on the rate
///
/// What it does not have is left out:
///
///     S kinetic(z, zd), electric(z, e);                // 0 without
///     double mass() const;                             // weight, half at each end; 0 without
///     EndMass end_mass() const;                        // inertia beside the axial one; none without
///     AxialDerivatives axial(z, zd, e);                // by hand; else by jets
///     std::string inadmissible(double z) const;        // empty if the length is admissible; else z > 0 is
///     std::string advice(double z, double zd, e);      // what the user should know of this state
///     void observe(add) const;                         // recorded quantities, see muscles/element_observables.hpp
template <class E>
concept AxialElement = requires(const E& element, double z, const Controls<double, E::n_controls>& e) {
  { element.elastic(z) } -> std::convertible_to<double>;
  { element.force(z, z, e) } -> std::convertible_to<double>;
  { element.dissipates() } -> std::convertible_to<bool>;
};

template <AxialElement Element, class S>
S kinetic_energy(const Element& element, const S& z, const S& zd) {
  if constexpr (requires { element.kinetic(z, zd); }) {
    return element.kinetic(z, zd);
  } else {
    return S(0.0);
  }
}

template <AxialElement Element, class S>
S electric_energy(const Element& element, const S& z, const Controls<S, Element::n_controls>& e) {
  if constexpr (requires { element.electric(z, e); }) {
    return element.electric(z, e);
  } else {
    return S(0.0);
  }
}

template <class Element>
double mass_of(const Element& element) {
  if constexpr (requires { element.mass(); }) {
    return element.mass();
  } else {
    return 0.0;
  }
}

template <AxialElement Element>
EndMass end_mass_of(const Element& element) {
  if constexpr (requires { element.end_mass(); }) {
    return element.end_mass();
  } else {
    return {};
  }
}

/// Why an element cannot have this length; empty if it can.
template <class Element>
std::string why_inadmissible(const Element& element, double z) {
  if constexpr (requires { element.inadmissible(z); }) {
    return element.inadmissible(z);
  } else {
    if (!std::isfinite(z)) return "its length is not finite";
    return z > 0.0 ? "" : "its ends coincide, so that its force has no direction";
  }
}

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
  const Jet l = kinetic_energy(element, z_jet, d_jet) - element.elastic(z_jet) - electric_energy(element, z_jet, e_jet);
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

/// Force with which the element pulls its ends together, inertia apart: dPi/dz - f; > 0 in tension.
template <AxialElement Element>
double pull(const Element& element, const AxialState<Element::n_controls>& at) {
  return 0.0 - axial_derivatives(element, at.z, 0.0, at.e).l_z - element.force(at.z, at.zd, at.e);
}

}  // namespace muldi::muscles
