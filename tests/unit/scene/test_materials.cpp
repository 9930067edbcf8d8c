#include "scene/materials.hpp"

#include <gtest/gtest.h>

#include "reading.hpp"

namespace muldi::scene {
namespace {

/// All five constants of a material with mu = 2 and nu = 0.3: E = 2 mu (1 + nu), lambda = 2 mu nu / (1 - 2 nu),
/// kappa = lambda + 2 mu / 3.
constexpr double mu = 2.0;
constexpr double nu = 0.3;
constexpr double young = 5.2;
constexpr double lambda = 3.0;
constexpr double kappa = 3.0 + 4.0 / 3.0;

TEST(NeoHookean, AnyPairOfConstantsDeterminesTheOthers) {
  const NeoHookean pairs[] = {{.young = young, .poisson = nu},    {.young = young, .mu = mu},
                              {.young = young, .lambda = lambda}, {.young = young, .kappa = kappa},
                              {.poisson = nu, .mu = mu},          {.poisson = nu, .lambda = lambda},
                              {.poisson = nu, .kappa = kappa},    {.mu = mu, .lambda = lambda},
                              {.mu = mu, .kappa = kappa},         {.lambda = lambda, .kappa = kappa}};
  for (const NeoHookean& pair : pairs) {
    EXPECT_EQ(pair.why_invalid(), "");
    EXPECT_DOUBLE_EQ(pair.shear_modulus(), mu);
    EXPECT_NEAR(pair.poisson_ratio(), nu, 1e-15);  // differences of numbers near one
  }
}

TEST(NeoHookean, SiliconeOfTheThesisIsIncompressible) {
  const NeoHookean silicone{.young = 0.7, .poisson = 0.5};
  EXPECT_DOUBLE_EQ(silicone.shear_modulus(), 0.7 / 3);
  EXPECT_EQ(silicone.poisson_ratio(), 0.5);
}

Material silicone() {
  return {.density = 1e-3,
          .elastic = {.law = NeoHookean{.young = 0.7, .poisson = 0.5}},
          .electric = Electric{.law = IdealDielectric{.relative_permittivity = 3.7}},
          .viscous = Viscous{.law = KelvinVoigt{.viscosity = 10}}};
}

TEST(LumpedMaterial, IsTheMaterialWithoutReplacements) { EXPECT_EQ(lumped_material(Muscle{}, silicone()), silicone()); }

TEST(LumpedMaterial, ReplacementsHoldForTheModelOnly) {
  Muscle muscle;
  muscle.section = {.shape = muscles::RoundSection{.diameter = 10}};
  muscle.lumped.section = muscles::Section{.shape = muscles::SquareSection{.edge = 11}};
  muscle.lumped.density = 2e-3;
  muscle.lumped.young = 1.4;
  muscle.lumped.relative_permittivity = 3.1;
  muscle.lumped.viscosity = 0.0;
  const Material material = lumped_material(muscle, silicone());
  EXPECT_EQ(material.density, 2e-3);
  EXPECT_DOUBLE_EQ(std::get<NeoHookean>(material.elastic.law).shear_modulus(), 1.4 / 3);
  EXPECT_EQ(std::get<IdealDielectric>(material.electric->law).relative_permittivity, 3.1);
  EXPECT_EQ(std::get<KelvinVoigt>(material.viscous->law).viscosity, 0.0);
  EXPECT_EQ(lumped_section(muscle), *muscle.lumped.section);
  muscle.lumped = {};
  muscle.lumped.shear_modulus = 0.3;
  EXPECT_EQ(std::get<NeoHookean>(lumped_material(muscle, silicone()).elastic.law).shear_modulus(), 0.3);
  EXPECT_EQ(lumped_section(muscle), muscle.section);
}

TEST(Materials, InvariantsTakePermittivityUnits) {
  const Scene scene = scene_of(
      "materials:\n"
      "  m:\n"
      "    density: 1 g/cm^3\n"
      "    elastic: {model: neo_hookean, mu: 0.2, poisson: 0.5}\n"
      "    electric: {model: invariants, c1: -1e-12 F/m, c2: 2e-12, c3: 3 pF/m}\n");
  const auto& law = std::get<Invariants>(scene.materials[0].value.electric->law);
  EXPECT_EQ(law.c1, -1e-12);  // F/m = mF/mm
  EXPECT_EQ(law.c2, 2e-12);
  EXPECT_DOUBLE_EQ(law.c3, 3e-12);
  EXPECT_FALSE(scene.materials[0].value.viscous.has_value());
}

}  // namespace
}  // namespace muldi::scene
