#pragma once
/// Elastic laws of materials. All numbers in the scene's units.
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "base/describe.hpp"

namespace muldi::scene {

/// Any two of five constants of isotropic elasticity (numerics.md 1.2).
struct ElasticConstants {
  std::optional<double> young = {};
  std::optional<double> poisson = {};
  std::optional<double> mu = {};
  std::optional<double> lambda = {};
  std::optional<double> kappa = {};

  /// Shear modulus from whichever two constants are given; NaN for any other number of them.
  double shear_modulus() const;
  /// Poisson's ratio from whichever two constants are given; 0.5 is incompressible.
  double poisson_ratio() const;
  /// Why the constants given make no stable material (not two of them, mu <= 0, nu outside (-1, 0.5]); empty if they
  /// do.
  std::string why_invalid() const;
};

/// describe() of the fields of ElasticConstants in a law that has them.
template <class Law, class Visit>
void describe_constants(Law& law, Visit& visit) {
  using namespace base;
  constexpr auto optional = Need::optional;
  visit(Field{.key = "young", .doc = "Young's modulus", .unit = dimension::stress, .range = positive, .need = optional},
        law.young);
  visit(Field{.key = "poisson",
              .doc = "Poisson's ratio; 0.5 is incompressible",
              .range = {.min = -1.0, .max = 0.5, .min_open = true},
              .need = optional},
        law.poisson);
  visit(Field{.key = "mu", .doc = "shear modulus", .unit = dimension::stress, .range = positive, .need = optional},
        law.mu);
  visit(Field{.key = "lambda", .doc = "first constant of Lame", .unit = dimension::stress, .need = optional},
        law.lambda);
  visit(Field{.key = "kappa", .doc = "bulk modulus", .unit = dimension::stress, .range = positive, .need = optional},
        law.kappa);
}

/// Volumetric energy of the laws that are isochoric otherwise.
enum class Volumetric { quadratic, logarithmic };

inline std::span<const base::Word<Volumetric>> words(Volumetric) {
  static constexpr base::Word<Volumetric> all[] = {
      {.word = "quadratic", .value = Volumetric::quadratic, .doc = "kappa/2 (J - 1)^2"},
      {.word = "logarithmic",
       .value = Volumetric::logarithmic,
       .doc = "kappa/4 (J^2 - 1 - 2 ln J), unbounded towards J = 0"},
  };
  return all;
}

template <class Visit, class Value>
void describe_volumetric(Value& volumetric, Visit& visit) {
  visit(base::Field{.key = "volumetric", .doc = "volumetric energy of a solid", .need = base::Need::optional},
        volumetric);
}

/// mu/2 (J^(-2/3) C:1 - 3) + U(J).
struct NeoHookean {
  static constexpr std::string_view name = "neo_hookean";
  static constexpr std::string_view doc = "neo-Hookean elasticity, given by any two of its constants";

  std::optional<double> young = {};
  std::optional<double> poisson = {};
  std::optional<double> mu = {};
  std::optional<double> lambda = {};
  std::optional<double> kappa = {};
  Volumetric volumetric = Volumetric::quadratic;

  ElasticConstants constants() const { return {young, poisson, mu, lambda, kappa}; }
  double shear_modulus() const { return constants().shear_modulus(); }
  double poisson_ratio() const { return constants().poisson_ratio(); }
  std::string why_invalid() const { return constants().why_invalid(); }

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    describe_constants(self, visit);
    describe_volumetric(self.volumetric, visit);
  }
  friend bool operator==(const NeoHookean&, const NeoHookean&) = default;
};

/// mu/2 (C:1 - 3) - mu ln J + lambda/2 ln^2 J.
struct BonetWood {
  static constexpr std::string_view name = "bonet_wood";
  static constexpr std::string_view doc =
      "neo-Hookean elasticity after Bonet and Wood, mu/2 (C:1 - 3) - mu ln J + lambda/2 ln^2 J; for the formulation "
      "`displacement`";

  std::optional<double> young = {};
  std::optional<double> poisson = {};
  std::optional<double> mu = {};
  std::optional<double> lambda = {};
  std::optional<double> kappa = {};

  ElasticConstants constants() const { return {young, poisson, mu, lambda, kappa}; }
  double shear_modulus() const { return constants().shear_modulus(); }
  double poisson_ratio() const { return constants().poisson_ratio(); }
  std::string why_invalid() const { return constants().why_invalid(); }

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    describe_constants(self, visit);
  }
  friend bool operator==(const BonetWood&, const BonetWood&) = default;
};

/// Poisson's ratio from the shear modulus and the one of both that is given; NaN for any other number of them.
double poisson_of(double mu, const std::optional<double>& poisson, const std::optional<double>& kappa);
/// What is wrong with a shear modulus and one of Poisson's ratio and bulk modulus; empty if nothing is.
std::string why_no_bulk(double mu, const std::optional<double>& poisson, const std::optional<double>& kappa);

template <class Self, class Visit>
void describe_bulk(Self& self, Visit& visit) {
  using namespace base;
  constexpr auto optional = Need::optional;
  visit(Field{.key = "poisson",
              .doc = "Poisson's ratio; 0.5 is incompressible",
              .range = {.min = -1.0, .max = 0.5, .min_open = true},
              .need = optional},
        self.poisson);
  visit(Field{.key = "kappa", .doc = "bulk modulus", .unit = dimension::stress, .range = positive, .need = optional},
        self.kappa);
  describe_volumetric(self.volumetric, visit);
}

/// mu_1/2 (J^(-2/3) I1 - 3) + mu_2/2 (J^(-4/3) I2 - 3) + U(J).
struct MooneyRivlin {
  static constexpr std::string_view name = "mooney_rivlin";
  static constexpr std::string_view doc =
      "mu_1/2 (J^(-2/3) I1 - 3) + mu_2/2 (J^(-4/3) I2 - 3), shear modulus mu_1 + mu_2; with poisson or kappa";

  double mu_1 = 0.0;
  double mu_2 = 0.0;
  std::optional<double> poisson = {};
  std::optional<double> kappa = {};
  Volumetric volumetric = Volumetric::quadratic;

  double shear_modulus() const { return mu_1 + mu_2; }
  double poisson_ratio() const { return poisson_of(shear_modulus(), poisson, kappa); }
  std::string why_invalid() const { return why_no_bulk(shear_modulus(), poisson, kappa); }

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "mu_1", .doc = "part of the shear modulus that goes with I1", .unit = dimension::stress},
          self.mu_1);
    visit(Field{.key = "mu_2", .doc = "part of the shear modulus that goes with I2", .unit = dimension::stress},
          self.mu_2);
    describe_bulk(self, visit);
  }
  friend bool operator==(const MooneyRivlin&, const MooneyRivlin&) = default;
};

/// -mu/2 J_m ln(1 - (J^(-2/3) C:1 - 3)/J_m) + U(J).
struct Gent {
  static constexpr std::string_view name = "gent";
  static constexpr std::string_view doc =
      "elasticity that locks at a largest stretch: -mu/2 J_m ln(1 - (J^(-2/3) C:1 - 3)/J_m); with poisson or kappa";

  double mu = 0.0;
  double locking = 0.0;  ///< J_m
  std::optional<double> poisson = {};
  std::optional<double> kappa = {};
  Volumetric volumetric = Volumetric::quadratic;

  double shear_modulus() const { return mu; }
  double poisson_ratio() const { return poisson_of(mu, poisson, kappa); }
  std::string why_invalid() const { return why_no_bulk(mu, poisson, kappa); }

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "mu", .doc = "shear modulus", .unit = dimension::stress, .range = positive}, self.mu);
    visit(Field{.key = "J_m", .doc = "value of J^(-2/3) C:1 - 3 that is never reached", .range = positive},
          self.locking);
    describe_bulk(self, visit);
  }
  friend bool operator==(const Gent&, const Gent&) = default;
};

using ElasticLaws = base::TypeList<NeoHookean, BonetWood, MooneyRivlin, Gent>;

struct Elastic {
  base::VariantOf<ElasticLaws> law = {};

  /// Shear modulus at rest.
  double shear_modulus() const {
    return std::visit([](const auto& of) { return of.shear_modulus(); }, law);
  }
  double poisson_ratio() const {
    return std::visit([](const auto& of) { return of.poisson_ratio(); }, law);
  }
  bool incompressible() const { return poisson_ratio() == 0.5; }
  /// kappa = 2 mu (1 + nu)/(3 (1 - 2 nu)); infinite where incompressible.
  double bulk_modulus() const {
    const double nu = poisson_ratio();
    return 2.0 * shear_modulus() * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu));
  }
  std::string why_invalid() const {
    return std::visit([](const auto& of) { return of.why_invalid(); }, law);
  }

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Choice{.key = "model", .doc = "elastic law"}, self.law);
  }
  friend bool operator==(const Elastic&, const Elastic&) = default;
};

}  // namespace muldi::scene
