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
