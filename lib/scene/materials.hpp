#pragma once
/// Materials: density, elastic law, electric law, viscous law. All numbers in the scene's units.
#include <optional>
#include <string>
#include <string_view>

#include "base/describe.hpp"

namespace muldi::scene {

/// Neo-Hookean elasticity, given by any two of its five constants (numerics.md 1.2).
struct NeoHookean {
  static constexpr std::string_view name = "neo_hookean";
  static constexpr std::string_view doc = "neo-Hookean elasticity, given by any two of its constants";

  std::optional<double> young = {};
  std::optional<double> poisson = {};
  std::optional<double> mu = {};
  std::optional<double> lambda = {};
  std::optional<double> kappa = {};

  /// Shear modulus from whichever two constants are given.
  double shear_modulus() const;
  /// Poisson's ratio from whichever two constants are given; 0.5 is incompressible.
  double poisson_ratio() const;
  /// Why the constants given make no stable material (not two of them, mu <= 0, nu outside (-1, 0.5]); empty if they
  /// do.
  std::string why_invalid() const;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(
        Field{.key = "young", .doc = "Young's modulus", .unit = dimension::stress, .range = positive, .need = optional},
        self.young);
    visit(Field{.key = "poisson",
                .doc = "Poisson's ratio; 0.5 is incompressible",
                .range = {.min = -1.0, .max = 0.5, .min_open = true},
                .need = optional},
          self.poisson);
    visit(Field{.key = "mu", .doc = "shear modulus", .unit = dimension::stress, .range = positive, .need = optional},
          self.mu);
    visit(Field{.key = "lambda", .doc = "first constant of Lame", .unit = dimension::stress, .need = optional},
          self.lambda);
    visit(Field{.key = "kappa", .doc = "bulk modulus", .unit = dimension::stress, .range = positive, .need = optional},
          self.kappa);
  }
  friend bool operator==(const NeoHookean&, const NeoHookean&) = default;
};

/// -1/2 eps0 eps_r J E.C^-1.E (numerics.md 1.2 `ideal`).
struct IdealDielectric {
  static constexpr std::string_view name = "ideal_dielectric";
  static constexpr std::string_view doc = "constant permittivity in the deformed material";

  double relative_permittivity = 1.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "relative_permittivity",
                      .doc = "permittivity as a multiple of that of vacuum",
                      .range = {.min = 1.0}},
          self.relative_permittivity);
  }
  friend bool operator==(const IdealDielectric&, const IdealDielectric&) = default;
};

/// c1 I3 + c2 I4 + c3 I5 - 1/2 eps0 J I4 with I3 = E.E, I4 = E.C^-1.E, I5 = E.C^-2.E: permittivity that depends on the
/// stretch (thesis 7.1.2, numerics.md 1.2 `I-law` and 1.10).
struct Invariants {
  static constexpr std::string_view name = "invariants";
  static constexpr std::string_view doc =
      "stretch-dependent permittivity: energy c1 E.E + c2 E.C^-1.E + c3 E.C^-2.E - eps0/2 J E.C^-1.E";

  double c1 = 0.0;
  double c2 = 0.0;
  double c3 = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "c1", .doc = "factor of E.E (-eps0/2 times the fit's c1)", .unit = dimension::permittivity},
          self.c1);
    visit(Field{.key = "c2", .doc = "factor of E.C^-1.E (-eps0/2 times the fit's c2)", .unit = dimension::permittivity},
          self.c2);
    visit(Field{.key = "c3", .doc = "factor of E.C^-2.E (+eps0/2 times the fit's c3)", .unit = dimension::permittivity},
          self.c3);
  }
  friend bool operator==(const Invariants&, const Invariants&) = default;
};

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

using ElasticLaws = base::TypeList<NeoHookean>;
using ElectricLaws = base::TypeList<IdealDielectric, Invariants>;
using ViscousLaws = base::TypeList<KelvinVoigt>;

struct Elastic {
  base::VariantOf<ElasticLaws> law = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Choice{.key = "model", .doc = "elastic law"}, self.law);
  }
  friend bool operator==(const Elastic&, const Elastic&) = default;
};

struct Electric {
  base::VariantOf<ElectricLaws> law = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Choice{.key = "model", .doc = "electric law"}, self.law);
  }
  friend bool operator==(const Electric&, const Electric&) = default;
};

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
