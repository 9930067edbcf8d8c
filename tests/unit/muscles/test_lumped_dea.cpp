/// Closed forms of the lumped muscle: numerics 3.1, 3.2, 3.8, and what derives from its law.
#include "muscles/lumped_dea.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace muldi::muscles {
namespace {

constexpr double eps0 = 8.8542e-12;  // the thesis's value, as in the tables

/// A bar of unit length and section: energies are densities, forces are nominal stresses.
LumpedDea unit_bar(double mu, const ElectricLaw& law) {
  return {.shear_modulus = mu, .density = 1e-3, .length = 1.0, .area = 1.0, .electric_law = law};
}
LumpedDea ideal_bar(double mu, double eps_r) { return unit_bar(mu, ElectricLaw::ideal(eps_r, eps0)); }

LumpedDea silicone(const Section& section, double length) {
  return {.shear_modulus = 0.7 / 3.0,
          .viscosity = 0.01,
          .density = 1e-3,
          .length = length,
          .area = section.area(),
          .shape_factor = section.shape_factor(),
          .electric_law = ElectricLaw::ideal(3.7, eps0),
          .inertia = Inertia::thesis};
}
LumpedDea membrane() { return silicone({SquareSection{20.0}}, 1.0); }
LumpedDea round_actuator() { return silicone({RoundSection{10.0}}, 40.0); }

double total_energy(const LumpedDea& muscle, double z, double field) {
  return muscle.elastic(z) + muscle.electric(z, Controls<double, 1>{field});
}

struct Equilibrium {
  double mu;
  double field;
  double stable;
  double unstable;
};
class FreeEquilibrium : public testing::TestWithParam<Equilibrium> {};

TEST_P(FreeEquilibrium, HasNoForceAtTheTabulatedStretches) {
  const auto [mu, field, stable, unstable] = GetParam();
  const LumpedDea bar = ideal_bar(mu, 3.7);
  for (const double stretch : {stable, unstable}) {
    // Twelve printed digits of the stretch leave about 1e-11 of the parts that cancel.
    const double part = mu / (stretch * stretch);
    EXPECT_NEAR(bar.potential_z(stretch, field) / part, 0.0, 2e-11);
  }
  EXPECT_GT(bar.potential_zz(stable, field), 0.0);
  EXPECT_LT(bar.potential_zz(unstable, field), 0.0);
}

// Table of numerics 3.1, eps_r 3.7: roots of L^4 - L + eps E^2/mu.
INSTANTIATE_TEST_SUITE_P(Table, FreeEquilibrium,
                         testing::Values(Equilibrium{0.2, 1e4, 0.994479175036, 0.0163803419933},
                                         Equilibrium{0.2, 2e4, 0.977129367611, 0.0655395307196},
                                         Equilibrium{0.2, 3e4, 0.945035322222, 0.147900931872},
                                         Equilibrium{0.2, 4e4, 0.890270854316, 0.267180173196},
                                         Equilibrium{0.2, 5e4, 0.780380936385, 0.450808489604},
                                         Equilibrium{0.7 / 3.0, 1e4, 0.995275419992, 0.0140402702885},
                                         Equilibrium{0.7 / 3.0, 2e4, 0.980531432033, 0.0561708807984},
                                         Equilibrium{0.7 / 3.0, 3e4, 0.953727609917, 0.126619120763},
                                         Equilibrium{0.7 / 3.0, 4e4, 0.909804644007, 0.22731364612},
                                         Equilibrium{0.7 / 3.0, 5e4, 0.833389955634, 0.369683313576}));

TEST(LumpedDea, PullsInAtTheTabulatedField) {
  struct Row {
    double mu, eps_r, field, true_field;
  };
  // Numerics 3.1: stretch 4^(-1/3), nominal and true field of pull-in.
  const double stretch = std::pow(4.0, -1.0 / 3.0);
  for (const Row& row :
       {Row{0.2, 3.7, 53706.4902334, 85253.7390941}, Row{0.7 / 3.0, 3.7, 58009.6395041, 92084.5627731},
        Row{0.233, 3.7, 57968.1892383, 92018.7645776}, Row{0.233, 3.1, 63330.0381392, 100530.169163}}) {
    const LumpedDea bar = ideal_bar(row.mu, row.eps_r);
    EXPECT_NEAR(bar.potential_z(stretch, row.field) / row.mu, 0.0, 1e-10);
    EXPECT_NEAR(bar.potential_zz(stretch, row.field) / row.mu, 0.0, 1e-10);
    EXPECT_NEAR(bar.true_field(stretch, row.field), row.true_field, 1e-6);
  }
}

TEST(LumpedDea, PullsInDynamicallyWhereTheEnergyTouchesThatOfTheStart) {
  // Numerics 3.1: stretch 0.465571231877; fields for mu 0.2 and 0.7/3.
  constexpr double stretch = 0.465571231877;
  for (const auto& [mu, field] : {std::pair{0.2, 50551.3508856}, std::pair{0.7 / 3.0, 54601.6995073}}) {
    const LumpedDea bar = ideal_bar(mu, 3.7);
    EXPECT_NEAR((total_energy(bar, stretch, field) - total_energy(bar, 1.0, field)) / mu, 0.0, 1e-10);
    EXPECT_NEAR(bar.potential_z(stretch, field) / mu, 0.0, 1e-10);
  }
}

TEST(LumpedDea, OfTheVuLawRestsAtTheTabulatedStretches) {
  // Numerics 3.1: mu 0.233, c2 1e-9; without eps0 the closed form (1 + 2 c2 E^2/mu)^(-1/3).
  const LumpedDea bar = unit_bar(0.233, ElectricLaw::vu(5e-8, 1e-9, eps0));
  for (const auto& [field, stretch] :
       {std::pair{6e3, 0.913696123658}, std::pair{1e4, 0.81210157033}, std::pair{2e4, 0.603567796926}}) {
    EXPECT_NEAR(bar.potential_z(stretch, field) / 0.233, 0.0, 1e-11);
  }
  const LumpedDea without = unit_bar(0.233, ElectricLaw::vu(5e-8, 1e-9, 0.0));
  EXPECT_NEAR(without.potential_z(std::cbrt(1.0 / (1.0 + 2e-9 * 1e8 / 0.233)), 1e4) / 0.233, 0.0, 1e-14);
}

TEST(LumpedDea, BlockedForceIsThatOfTheClosedForm) {
  // Numerics 3.2: d = 10 mm, A eps E^2 and A (2 c2 + eps0) E^2.
  const Section section{RoundSection{10.0}};
  LumpedDea muscle{.shear_modulus = 0.2, .length = 100.0, .area = section.area()};
  const auto blocked = [&](const ElectricLaw& law, double field) {
    muscle.electric_law = law;
    return muscle.pull(100.0, 0.0, field);
  };
  EXPECT_NEAR(blocked(ElectricLaw::ideal(3.0, eps0), 2e4), 0.834488690202, 1e-12);
  EXPECT_NEAR(blocked(ElectricLaw::ideal(3.7, eps0), 2e4), 1.02920271792, 1e-11);
  EXPECT_NEAR(blocked(ElectricLaw::ideal(3.7, eps0), 3e4), 2.31570611531, 1e-11);
  EXPECT_NEAR(blocked(ElectricLaw::vu(5e-8, 1e-9, eps0), 2e4), 63.1100159685, 1e-9);
}

TEST(LumpedDea, MembraneHasTheTabulatedMassStiffnessAndFrequency) {
  // Numerics 3.8: square 20 x 20 x 1 mm at 30 kV/mm about its equilibrium.
  const auto d = membrane().axial(0.953727609917, 0.0, Controls<double, 1>{3e4});
  EXPECT_NEAR(d.l_dd, 7.71818828337, 1e-10);
  EXPECT_NEAR(-d.l_zz, 265.745364033, 1e-8);
  EXPECT_NEAR(std::sqrt(-d.l_zz / d.l_dd), 5.86779812517, 1e-10);
}

TEST(LumpedDea, RoundActuatorHasTheTabulatedFrequenciesAndCriticalDamping) {
  // Numerics 3.8 (frequencies, critical viscosity) and reference-results A (equilibria).
  struct Row {
    double field, length, omega;
  };
  for (const Row& row : {Row{0.0, 40.0, 2.26489977535}, Row{3e4, 38.149104396663, 2.20264574176},
                         Row{4e4, 36.392185760271, 2.12957431947}}) {
    const auto d = round_actuator().axial(row.length, 0.0, Controls<double, 1>{row.field});
    EXPECT_NEAR(d.l_z, 0.0, 1e-11);
    EXPECT_NEAR(std::sqrt(-d.l_zz / d.l_dd), row.omega, 1e-11);
  }
  const auto d = round_actuator().axial(38.149104396663, 0.0, Controls<double, 1>{3e4});
  const double viscosity = 0.01 * 2.0 * std::sqrt(-d.l_zz * d.l_dd) / -d.f_d;
  EXPECT_NEAR(viscosity, 0.365804041344, 1e-11);
}

TEST(LumpedDea, BothInertiasAgreeForAMuscleWhoseCentreRests) {
  // Numerics C9: ends at +-zd/2 along the axis.
  LumpedDea muscle = round_actuator();
  constexpr double zd = 0.3;
  const auto kinetic = [&](Inertia inertia) {
    muscle.inertia = inertia;
    const EndMass m = muscle.end_mass();
    return 0.125 * zd * zd * (m.m11 - 2.0 * m.m12 + m.m22) + muscle.kinetic(38.0, zd);
  };
  EXPECT_NEAR(kinetic(Inertia::consistent), kinetic(Inertia::thesis), 1e-16);
  // Thesis (7.60): m zd^2/48 (3/pi V z^-3 + 2), m = rho pi 25 40.
  const double volume = std::acos(-1.0) * 1000.0;
  EXPECT_NEAR(kinetic(Inertia::thesis), volume * 1e-3 * zd * zd / 48.0 * (3000.0 / 38.0 / 38.0 / 38.0 + 2.0), 1e-15);
}

TEST(LumpedDea, ConsistentInertiaIsThatOfARodThatTurns) {
  // A rod about its centre: m z^2/12 omega^2/2; ends at +- omega z/2 across the axis.
  LumpedDea muscle = round_actuator();
  muscle.inertia = Inertia::consistent;
  const EndMass m = muscle.end_mass();
  constexpr double omega = 0.2;
  const double speed = 0.5 * omega * 40.0;
  EXPECT_NEAR(0.5 * speed * speed * (m.m11 - 2.0 * m.m12 + m.m22), muscle.mass() * 1600.0 / 24.0 * omega * omega,
              1e-13);
  // Translation: half of mass times speed squared for both.
  EXPECT_NEAR(m.m11 + 2.0 * m.m12 + m.m22, muscle.mass(), 1e-15);
  muscle.inertia = Inertia::thesis;
  EXPECT_NEAR(muscle.end_mass().m11 + 2.0 * muscle.end_mass().m12 + muscle.end_mass().m22, muscle.mass(), 1e-15);
}

TEST(LumpedDea, ElectricEnergyIsThatOfItsLayersInParallel) {
  // Numerics 1.10: N = Z/t layers at U_l = E t hold -1/2 N C_l U_l^2; Q_l = C_l U_l.
  const LumpedDea muscle = round_actuator();
  constexpr double t = 0.01;
  constexpr double field = 3e4;
  constexpr double z = 38.0;
  const double layer_voltage = field / field_per_layer_voltage(t);
  const double capacitance = muscle.layer_capacitance(z, t);
  EXPECT_NEAR(muscle.electric(z, Controls<double, 1>{field}),
              -0.5 * (40.0 / t) * capacitance * layer_voltage * layer_voltage, 1e-13);
  EXPECT_NEAR(muscle.layer_charge(z, field), capacitance * layer_voltage, 1e-20);
  // Numerics 4.5: d = 10, t = 10 um, eps_r 3.7, undeformed: 2.573e-7 mF.
  EXPECT_NEAR(muscle.layer_capacitance(40.0, t), 2.573e-7, 1e-10);
  EXPECT_DOUBLE_EQ(field_per_total_voltage(40.0) * (40.0 / t) * layer_voltage, field);
}

TEST(LumpedDea, BucklesUnderTheEulerLoadOfItsSofterModulus) {
  // Numerics 1.10 at stretch 1: pi^2 (3 mu - 3 eps E^2) I / Z^2, I = pi d^4/64.
  const LumpedDea muscle = round_actuator();
  const double pi = std::acos(-1.0);
  const double second_moment = pi * 1e4 / 64.0;
  const double modulus = 0.7 - 3.0 * 3.7 * eps0 * 9e8;
  EXPECT_NEAR(muscle.buckling_load(40.0, 3e4), pi * pi * modulus * second_moment / 1600.0, 1e-12);
  EXPECT_EQ(muscle.buckling_load(30.0, 7e4), 0.0);
}

TEST(LumpedDea, DampingForceGrowsWithTheRateOfTheStretch) {
  // Thesis (7.59): f = -3/2 eta V zd/z^2; it adds to the pull of a muscle that lengthens.
  const LumpedDea muscle = round_actuator();
  const double force = -1.5 * 0.01 * muscle.volume() * 0.2 / (38.0 * 38.0);
  EXPECT_DOUBLE_EQ(muscle.force(38.0, 0.2, Controls<double, 1>{0.0}), force);
  EXPECT_DOUBLE_EQ(muscle.pull(38.0, 0.2, 0.0), muscle.pull(38.0, 0.0, 0.0) - force);
}

TEST(LumpedDea, IsInadmissibleAtAFifthOfItsLengthAndBelow) {
  const LumpedDea muscle = round_actuator();
  EXPECT_EQ(muscle.inadmissible(8.1), "");
  EXPECT_EQ(muscle.inadmissible(4.8), "stretch 0.12 below 0.2");
  EXPECT_FALSE(muscle.inadmissible(std::nan("")).empty());
}

TEST(Section, HasItsAreaAndShapeFactor) {
  const double pi = std::acos(-1.0);
  const Section disc{RoundSection{10.0}};
  EXPECT_DOUBLE_EQ(disc.area(), 25.0 * pi);
  EXPECT_DOUBLE_EQ(disc.shape_factor(), 12.0 * (pi * 1e4 / 64.0) / (625.0 * pi * pi));  // 12 I / A^2
  const Section square{SquareSection{20.0}};
  EXPECT_DOUBLE_EQ(square.area(), 400.0);
  EXPECT_DOUBLE_EQ(square.shape_factor(), 1.0);
}

}  // namespace
}  // namespace muldi::muscles
