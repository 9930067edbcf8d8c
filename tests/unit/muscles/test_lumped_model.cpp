/// How the lumped model is made from what a scene gives.
#include <gtest/gtest.h>

#include "muscles/lumped_dea.hpp"

namespace muldi::muscles {
namespace {

constexpr double eps0 = 8.8542e-12;

MuscleGiven given() {
  return {.section = {RoundSection{10.0}},
          .length = 100.0,
          .layer_thickness = 0.01,
          .density = 1e-3,
          .shear_modulus = 0.7 / 3,
          .viscosity = 10.0,
          .electric_law = ElectricLaw::ideal(3.7, eps0),
          .eps0 = eps0};
}

TEST(LumpedModel, IsTheMuscleWithoutReplacements) {
  const LumpedDea element = LumpedModel{}.element(given());
  EXPECT_EQ(element.shear_modulus, 0.7 / 3);
  EXPECT_EQ(element.viscosity, 10.0);
  EXPECT_EQ(element.density, 1e-3);
  EXPECT_EQ(element.length, 100.0);
  EXPECT_EQ(element.area, given().section.area());
  EXPECT_EQ(element.shape_factor, RoundSection::shape_factor());
  EXPECT_EQ(element.electric_law.a_m2, -0.5 * eps0 * 3.7);
  EXPECT_EQ(element.inertia, Inertia::consistent);
  EXPECT_EQ(element.layer_thickness, 0.01);
}

TEST(LumpedModel, ReplacementsHoldForTheModel) {
  LumpedModel model;
  model.replacements = {.section = Section{SquareSection{11.0}},
                        .young = 1.4,
                        .viscosity = 0.0,
                        .density = 2e-3,
                        .relative_permittivity = 3.1};
  const LumpedDea element = model.element(given());
  EXPECT_EQ(element.area, 121.0);
  EXPECT_DOUBLE_EQ(element.shear_modulus, 1.4 / 3);
  EXPECT_EQ(element.viscosity, 0.0);
  EXPECT_FALSE(element.dissipates());
  EXPECT_EQ(element.density, 2e-3);
  EXPECT_EQ(element.electric_law.a_m2, -0.5 * eps0 * 3.1);
  model.replacements = {.shear_modulus = 0.3};
  EXPECT_EQ(model.element(given()).shear_modulus, 0.3);
}

TEST(LumpedModel, EndFactorStiffensByDiameterOverLength) {
  LumpedModel model;
  EXPECT_EQ(model.end_factor, 0.0);
  EXPECT_EQ(model.stiffness_of_ends(given()), 1.0);
  model.end_factor = 0.5;
  const LumpedDea element = model.element(given());
  // 1 + k d/Z with k = 1/2, d = 10, Z = 100.
  EXPECT_DOUBLE_EQ(element.shear_modulus, 1.05 * 0.7 / 3);
  EXPECT_DOUBLE_EQ(element.viscosity, 1.05 * 10.0);
  // Forces of the field and the mass stay: without stretch the ends disturb nothing.
  const LumpedDea free = LumpedModel{}.element(given());
  EXPECT_EQ(element.potential_z(1.0, 3e4), free.potential_z(1.0, 3e4));
  EXPECT_EQ(element.mass(), free.mass());
  // A bar that is shorter by k d is stiffer by 1/(1 - k d/Z): the same to the first order of d/Z.
  MuscleGiven shorter = given();
  shorter.length -= 0.5 * 10.0;
  const double same = LumpedModel{}.element(shorter).potential_zz(1.0, 0.0);
  EXPECT_NEAR(element.potential_zz(1.0, 0.0) / same, 1.0 - 0.05 * 0.05, 1e-14);
}

TEST(LumpedModel, RefusesTwoElasticConstants) {
  LumpedModel model;
  EXPECT_FALSE(model.fault().has_value());
  model.replacements = {.young = 0.7, .shear_modulus = 0.3};
  ASSERT_TRUE(model.fault().has_value());
  EXPECT_EQ(model.fault()->key, "mu");
  EXPECT_EQ(model.fault()->message, "give either young or mu, not both");
}

TEST(LumpedModel, IsDrivenWhereItIsADielectric) {
  LumpedModel model;
  EXPECT_FALSE(model.is_driven(false));
  EXPECT_TRUE(model.is_driven(true));
  model.replacements.relative_permittivity = 3.0;
  EXPECT_TRUE(model.is_driven(false));
}

TEST(LumpedModel, MakesAFieldOfEveryQuantity) {
  EXPECT_EQ(LumpedModel::control_factor("field", given()), 1.0);
  EXPECT_EQ(LumpedModel::control_factor("layer_voltage", given()), 1.0 / 0.01);
  EXPECT_EQ(LumpedModel::control_factor("total_voltage", given()), 1.0 / 100.0);
}

TEST(LumpedModel, HasItsInertiaInTheLengthWhereItIsIsolated) {
  MuscleGiven isolated = given();
  isolated.isolated = true;
  EXPECT_EQ(LumpedModel{}.element(isolated).inertia, Inertia::thesis);
}

}  // namespace
}  // namespace muldi::muscles
