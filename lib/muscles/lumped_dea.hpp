#pragma once
/// The lumped dielectric elastomer muscle: homogeneous uniaxial stretch at constant volume (thesis 7.2, numerics 1.10).
///
/// With the length z, the reference length Z, the stretch L = z/Z, the volume V = A Z and the nominal field E:
///
///     T  = axial inertia b z^-3 zd^2 + c zd^2 and the inertia of the ends
///     Pi = V [ mu/2 (L^2 + 2/L - 3) + E^2 w(L) ]
///     f  = -3/2 eta V zd / z^2
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/describe.hpp"
#include "base/mutation.hpp"
#include "muscles/axial.hpp"
#include "muscles/electric_law.hpp"
#include "muscles/muscle_model.hpp"

namespace muldi::muscles {

/// Inertia of the muscle in a multibody system (numerics C9).
enum class Inertia { consistent, thesis };

inline constexpr std::array<base::Word<Inertia>, 2> inertia_words{
    {{.word = "consistent", .value = Inertia::consistent, .doc = "a uniform rod, with its rotational inertia"},
     {.word = "thesis",
      .value = Inertia::thesis,
      .doc = "a point mass at the centre and the axial rate (thesis 7.2.5)"}}};
constexpr std::span<const base::Word<Inertia>> words(Inertia) { return inertia_words; }

/// The muscle as a two-point element. The control is the nominal field E (voltage over reference length).
struct LumpedDea {
  static constexpr std::string_view folder = "muscles";
  static constexpr std::string_view noun = "muscle";
  static constexpr int n_controls = 1;
  static constexpr double least_stretch = 0.2;  ///< below it the model has long lost its meaning (numerics 1.10)

  double shear_modulus = 0.0;  ///< mu
  double viscosity = 0.0;      ///< eta
  double density = 0.0;        ///< rho0
  double length = 0.0;         ///< Z, reference length
  double area = 0.0;           ///< A, reference area of the section
  double shape_factor = 1.0;   ///< k of the section
  ElectricLaw electric_law{};
  Inertia inertia = Inertia::consistent;
  std::optional<double> layer_thickness = {};  ///< of the reference shape, if known

  double volume() const { return area * length; }
  double mass() const { return density * volume(); }

  /// m/6 (v1.v1 + v1.v2 + v2.v2), a rod; thesis: m/2 of the mean velocity.
  EndMass end_mass() const {
    const double m = mass();
    if (inertia == Inertia::thesis) return {.m11 = 0.25 * m, .m12 = 0.25 * m, .m22 = 0.25 * m};
    return {.m11 = m / 3.0, .m12 = m / 6.0, .m22 = m / 3.0};
  }

  /// b zd^2 / z^3: lateral expansion; thesis: and c zd^2, which the rod holds in its ends (thesis 7.47, 7.60).
  template <class S>
  S kinetic(const S& z, const S& zd) const {
    return (lateral_inertia() / (z * z * z) + axial_inertia()) * zd * zd;
  }
  template <class S>
  S elastic(const S& z) const {
    const S stretch = z / length;
    return 0.5 * volume() * shear_modulus * (stretch * stretch + 2.0 / stretch - 3.0);
  }
  /// Electric enthalpy: -1/2 C U^2.
  template <class S>
  S electric(const S& z, const Controls<S, 1>& field) const {
    return volume() * field[0] * field[0] * electric_law.w(S(z / length));
  }
  template <class S>
  S force(const S& z, const S& zd, const Controls<S, 1>&) const {
    return -1.5 * viscosity * volume() * zd / (z * z);
  }

  template <class S>
  AxialDerivatives<S, 1> axial(const S& z, const S& zd, const Controls<S, 1>& field) const {
    const S stretch = z / length;
    const S i = 1.0 / z;
    const S b3 = lateral_inertia() * i * i * i;
    const S rate = zd * i;
    const S drag = base::times_missing_half() * 1.5 * viscosity * volume() * i * i;
    return {.l_z = -3.0 * b3 * rate * zd - potential_z(stretch, field[0]),
            .l_d = 2.0 * (b3 + axial_inertia()) * zd,
            .l_zz = 12.0 * b3 * rate * rate - potential_zz(stretch, field[0]),
            .l_zd = -6.0 * b3 * rate,
            .l_dd = 2.0 * (b3 + axial_inertia()),
            .f = -drag * zd,
            .f_z = 2.0 * drag * rate,
            .f_d = -drag,
            .h_e = {-2.0 * area * field[0] * electric_law.w_L(stretch)}};
  }

  std::string inadmissible(double z) const;
  /// Says so where the muscle is compressed beyond its buckling load: the lumped model stays straight (numerics 1.10).
  std::string advice(double z, double zd, const Controls<double, 1>& field) const;
  bool dissipates() const { return viscosity > 0.0; }

  /// Stretch and fields; voltage and charge of one layer where its thickness is known.
  template <class Add>
  void observe(Add add) const {
    namespace dimension = base::dimension;
    using State = AxialState<1>;
    add("stretch", dimension::none, "length over reference length", [*this](const State& at) { return at.z / length; });
    add("field", dimension::field, "nominal field: voltage over reference length",
        [](const State& at) { return at.e[0]; });
    add("true_field", dimension::field, "field in the deformed muscle",
        [*this](const State& at) { return true_field(at.z, at.e[0]); });
    if (!layer_thickness) return;
    add("layer_voltage", dimension::voltage, "voltage of one layer",
        [*this](const State& at) { return at.e[0] * *layer_thickness; });
    add("charge", dimension::charge, "charge on one layer",
        [*this](const State& at) { return layer_charge(at.z, at.e[0]); });
  }

  /// dPi/dz at stretch L and nominal field E: the force with which the charged muscle pulls at rest.
  template <class S>
  S potential_z(const S& stretch, const S& field) const {
    return area * (shear_modulus * (stretch - 1.0 / (stretch * stretch)) + field * field * electric_law.w_L(stretch));
  }
  /// d2Pi/dz2; its change of sign is the pull-in of the free muscle.
  template <class S>
  S potential_zz(const S& stretch, const S& field) const {
    const S i = 1.0 / stretch;
    return area / length * (shear_modulus * (1.0 + 2.0 * i * i * i) + field * field * electric_law.w_LL(stretch));
  }

  /// Force with which the muscle pulls its ends together, inertia apart: dPi/dz - f; > 0 in tension.
  double pull(double z, double zd, double field) const {
    return potential_z(z / length, field) - force(z, zd, Controls<double, 1>{field});
  }
  /// Field in the deformed muscle, E / L.
  double true_field(double z, double field) const { return field * length / z; }
  /// Charge on one layer, -dOmega/dE A; the sign of the field. It does not depend on the layer's thickness.
  double layer_charge(double z, double field) const { return -2.0 * area * field * electric_law.w(z / length); }
  /// Capacitance of one layer of reference thickness t.
  double layer_capacitance(double z, double t) const { return -2.0 * area * electric_law.w(z / length) / t; }
  /// Compressive force under which a slender pinned muscle buckles: pi^2 W'' I / z^2, W'' the axial tangent modulus at
  /// this stretch and field; (3 mu - 3 eps E^2) I pi^2 / Z^2 for an ideal dielectric at L = 1. 0 beyond pull-in.
  double buckling_load(double z, double field) const {
    const double second_moment = shape_factor * area * area / 12.0;
    const double modulus = potential_zz(z / length, field) * length / area;
    return std::max(0.0, std::numbers::pi * std::numbers::pi * modulus * second_moment / (z * z));
  }

 private:
  double lateral_inertia() const { return shape_factor * mass() * volume() / 48.0; }
  double axial_inertia() const { return inertia == Inertia::thesis ? mass() / 24.0 : 0.0; }
};

/// What a scene says under `lumped:` of a muscle.
struct LumpedModel {
  static constexpr std::string_view name = "lumped";
  static constexpr std::string_view doc = "one uniform axial stretch between two points";
  static constexpr std::span<const std::string_view> quantities = field_quantities;

  Inertia inertia = Inertia::consistent;
  double end_factor = 0.0;  ///< k of stiffness_of_ends
  Replacements replacements = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "inertia", .doc = "inertia of the muscle", .need = base::Need::optional}, self.inertia);
    visit(base::Field{.key = "end_factor",
                      .doc = "k of the factor 1 + k d/Z on stiffness and viscosity, d the diameter of the section's "
                             "area and Z the reference length, by which plates on the ends that keep them from "
                             "widening stiffen the muscle; 0: free ends",
                      .range = {.min = -0.1},  // below 0 so that a fit may begin there
                      .need = base::Need::optional},
          self.end_factor);
    Replacements::describe(self.replacements, visit);
  }

  friend bool operator==(const LumpedModel&, const LumpedModel&) = default;

  std::optional<Fault> fault() const { return replacements.fault(); }
  bool is_driven(bool dielectric) const { return replacements.is_dielectric(dielectric); }

  LumpedDea element(MuscleGiven given) const {
    replacements.apply(given);
    const double ends = stiffness_of_ends(given);
    return {.shear_modulus = ends * given.shear_modulus,
            .viscosity = ends * given.viscosity,
            .density = given.density,
            .length = given.length,
            .area = given.section.area(),
            .shape_factor = given.section.shape_factor(),
            .electric_law = given.electric_law,
            // With the centre at rest both inertias are the same, and this one is a function of the length alone.
            .inertia = given.isolated ? Inertia::thesis : inertia,
            .layer_thickness = given.layer_thickness};
  }
  /// 1 + k d/Z: what plates on the ends add to the stiffness of a slender bar.
  ///
  /// By Saint-Venant's principle the plates disturb the uniform stretch only within about a diameter d of each end, in
  /// zones whose shape does not depend on the length Z. There the bar is stretched less, as if it were shorter by k d
  /// for some number k: force over stretch grows by Z/(Z - k d) = 1 + k d/Z in the first order of d/Z. Elastic and
  /// viscous stress of an incompressible bar have the same field of deformation, so the factor is that of both. The
  /// blocked force is not changed, for the uniform state at stretch 1 does not widen: the electric law stays as it is.
  double stiffness_of_ends(const MuscleGiven& given) const {
    return 1.0 + end_factor * 2.0 * std::sqrt(given.section.area() / std::numbers::pi) / given.length;
  }
  /// The control is the nominal field.
  static double control_factor(std::string_view quantity, const MuscleGiven& given) {
    return field_factor(quantity, given);
  }
};

}  // namespace muldi::muscles
