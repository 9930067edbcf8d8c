#pragma once
/// Electric enthalpy of a dielectric that is stretched uniaxially at constant volume, field along the axis.
///
/// With the nominal field E and the axial stretch L the enthalpy density is E^2 w(L),
///
///     w = a_2 L^2 + a_0 + a_m2 L^-2 + a_m4 L^-4 ,
///
/// which holds the linear laws of numerics 1.2: C^-1 = L^-2 and C = L^2 along the axis, J = 1.

namespace muldi::muscles {

/// The four coefficients; units of a permittivity.
struct ElectricLaw {
  double a_2 = 0.0;
  double a_0 = 0.0;
  double a_m2 = 0.0;
  double a_m4 = 0.0;

  /// -1/2 eps0 eps_r I4 with I4 = E.C^-1.E; `eps0` in the units of the scene.
  static constexpr ElectricLaw ideal(double relative_permittivity, double eps0) {
    return {.a_m2 = -0.5 * eps0 * relative_permittivity};
  }
  /// c1 I3 + c2 I4 + c3 I5 - 1/2 eps0 I4: stretch-dependent permittivity (thesis 7.1.2), I3 = E.E, I5 = E.C^-2.E.
  static constexpr ElectricLaw invariants(double c1, double c2, double c3, double eps0) {
    return {.a_0 = c1, .a_m2 = c2 - 0.5 * eps0, .a_m4 = c3};
  }
  /// c1 E.E + c2 E.C.E - 1/2 eps0 I4: the law of thesis chapters 4 and 5 (numerics C1).
  static constexpr ElectricLaw vu(double c1, double c2, double eps0) {
    return {.a_2 = c2, .a_0 = c1, .a_m2 = -0.5 * eps0};
  }

  /// w and its derivatives; S is double or a jet.
  template <class S>
  S w(const S& stretch) const {
    const S i2 = 1.0 / (stretch * stretch);
    return a_2 * stretch * stretch + a_0 + i2 * (a_m2 + a_m4 * i2);
  }
  template <class S>
  S w_L(const S& stretch) const {
    const S i = 1.0 / stretch;
    const S i2 = i * i;
    return 2.0 * a_2 * stretch - i * i2 * (2.0 * a_m2 + 4.0 * a_m4 * i2);
  }
  template <class S>
  S w_LL(const S& stretch) const {
    const S i2 = 1.0 / (stretch * stretch);
    return 2.0 * a_2 + i2 * i2 * (6.0 * a_m2 + 20.0 * a_m4 * i2);
  }
};

/// eps_F of thesis (7.23), (7.36): the electrostatic pressure is eps0 eps_F (true field)^2.
inline double force_permittivity(const ElectricLaw& law, double stretch, double eps0) {
  return stretch * stretch * stretch * law.w_L(stretch) / eps0;
}

/// eps_C of thesis (7.19), (7.37): true displacement over eps0 and true field, measured by capacitance.
inline double capacity_permittivity(const ElectricLaw& law, double stretch, double eps0) {
  return -2.0 * stretch * stretch * law.w(stretch) / eps0;
}

}  // namespace muldi::muscles
