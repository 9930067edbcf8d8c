#pragma once
/// What a muscle model is made from, and what models of dielectric muscles share.
#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "base/describe.hpp"
#include "muscles/electric_law.hpp"
#include "muscles/section.hpp"

namespace muldi::muscles {

/// What a scene gives to every muscle, in its units.
struct MuscleGiven {
  Section section = {};                        ///< undeformed
  double length = 0.0;                         ///< Z, reference length
  std::optional<double> layer_thickness = {};  ///< of the reference shape
  double density = 0.0;
  double shear_modulus = 0.0;
  double poisson_ratio = 0.5;
  double viscosity = 0.0;
  ElectricLaw electric_law = {};  ///< zero: no dielectric
  double eps0 = 0.0;              ///< in the units of the scene
  bool isolated = false;          ///< the midpoint rests, the length is the only unknown (thesis 7.2)
};

/// What is wrong with the options of a model, at one of their keys.
struct Fault {
  std::string_view key;
  std::string_view message;
};

/// Quantities of controls that are a nominal field or make one.
inline constexpr std::array<std::string_view, 3> field_quantities{"field", "layer_voltage", "total_voltage"};

/// Nominal field a volt of layer voltage: 1/t; of total voltage over the whole length: 1/Z (numerics 1.10).
constexpr double field_per_layer_voltage(double layer_thickness) { return 1.0 / layer_thickness; }
constexpr double field_per_total_voltage(double length) { return 1.0 / length; }

/// From a control of one of the field_quantities to the nominal field.
constexpr double field_factor(std::string_view quantity, const MuscleGiven& given) {
  if (quantity == "layer_voltage") return field_per_layer_voltage(given.layer_thickness.value());
  return quantity == "total_voltage" ? field_per_total_voltage(given.length) : 1.0;
}

/// Options that replace for one model what the muscle and its material say.
struct Replacements {
  std::optional<Section> section = {};
  std::optional<double> young = {};
  std::optional<double> shear_modulus = {};
  std::optional<double> viscosity = {};
  std::optional<double> density = {};
  std::optional<double> relative_permittivity = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using base::Field;
    using base::Need;
    visit(Field{.key = "section", .doc = "replaces the muscle's section", .need = Need::optional}, self.section);
    visit(Field{.key = "young",
                .doc = "replaces Young's modulus of the material, with its Poisson's ratio",
                .unit = base::dimension::stress,
                .range = base::positive,
                .need = Need::optional},
          self.young);
    visit(Field{.key = "mu",
                .doc = "replaces the shear modulus of the material",
                .unit = base::dimension::stress,
                .range = base::positive,
                .need = Need::optional},
          self.shear_modulus);
    visit(Field{.key = "viscosity",
                .doc = "replaces the viscosity of the material",
                .unit = base::dimension::viscosity,
                .range = base::non_negative,
                .need = Need::optional},
          self.viscosity);
    visit(Field{.key = "density",
                .doc = "replaces the density of the material",
                .unit = base::dimension::density,
                .range = base::positive,
                .need = Need::optional},
          self.density);
    visit(Field{.key = "relative_permittivity",
                .doc = "replaces the electric law of the material by an ideal dielectric",
                .range = {.min = 1.0},
                .need = Need::optional},
          self.relative_permittivity);
  }

  friend bool operator==(const Replacements&, const Replacements&) = default;

  std::optional<Fault> fault() const {
    if (!young || !shear_modulus) return {};
    return Fault{.key = "mu", .message = "give either young or mu, not both"};
  }
  /// Whether the muscle is a dielectric if its material is one, or is none.
  bool is_dielectric(bool material_is) const { return material_is || relative_permittivity; }

  void apply(MuscleGiven& given) const {
    if (section) given.section = *section;
    if (young) given.shear_modulus = *young / (2 * (1 + given.poisson_ratio));
    if (shear_modulus) given.shear_modulus = *shear_modulus;
    if (viscosity) given.viscosity = *viscosity;
    if (density) given.density = *density;
    if (relative_permittivity) given.electric_law = ElectricLaw::ideal(*relative_permittivity, given.eps0);
  }
};

}  // namespace muldi::muscles
