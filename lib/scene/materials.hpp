#pragma once
/// Materials: density, elastic law, electric law, viscous law. All numbers in the scene's units.
#include <optional>
#include <string_view>

#include "base/describe.hpp"
#include "scene/elastic_laws.hpp"
#include "scene/electric_laws.hpp"

namespace muldi::scene {

/// P = eta/2 J (F^-T dF/dt^T F^-T + dF/dt C^-1) (numerics.md 1.3).
struct KelvinVoigt {
  static constexpr std::string_view name = "kelvin_voigt";
  static constexpr std::string_view doc = "viscous stress parallel to the elastic one";

  double viscosity = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "viscosity",
                      .doc = "viscosity eta of sigma = eta d, d the rate of deformation",
                      .unit = base::dimension::viscosity,
                      .range = base::non_negative},
          self.viscosity);
  }
  friend bool operator==(const KelvinVoigt&, const KelvinVoigt&) = default;
};

using ViscousLaws = base::TypeList<KelvinVoigt>;

struct Viscous {
  base::VariantOf<ViscousLaws> law = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Choice{.key = "model", .doc = "viscous law"}, self.law);
  }
  friend bool operator==(const Viscous&, const Viscous&) = default;
};

struct Material {
  double density = 0.0;
  Elastic elastic = {};
  std::optional<Electric> electric = {};  ///< none: no dielectric
  std::optional<Viscous> viscous = {};    ///< none: no damping terms

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "density", .doc = "mass by volume", .unit = dimension::density, .range = positive},
          self.density);
    visit(Field{.key = "elastic", .doc = "elastic law"}, self.elastic);
    visit(Field{.key = "electric", .doc = "electric law; without it no dielectric", .need = Need::optional},
          self.electric);
    visit(Field{.key = "viscous", .doc = "viscous law; without it no damping", .need = Need::optional}, self.viscous);
  }
  friend bool operator==(const Material&, const Material&) = default;
};

}  // namespace muldi::scene
