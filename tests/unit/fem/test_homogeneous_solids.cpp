/// Solids that strain homogeneously under a field against closed forms (numerics 3.1, 3.2): stretch, blocked force,
/// pull-in.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "statics/sweep.hpp"
#include "support/solid_system.hpp"

namespace muldi::fem {
namespace {

using statics::SweepResult;

constexpr double permittivity = 3.7 * test::eps0_si;

/// A cube of side 1 mm of distorted cells with symmetry planes; control 0 is the voltage across z, so the field.
test::SolidSystem cube(const Material& material, double mu, Formulation formulation) {
  test::SolidSystem system = test::solid_of(test::cube_of(2));
  system.hold_lower_faces();
  system.set_potential(test::plane(2, 0.0), {});
  system.set_potential(test::plane(2, 1.0), system.control(0.0));
  system.fill(material, mu, formulation);
  return system;
}

Material with_ideal(Material material) {
  material.electric = IdealDielectric{.permittivity = permittivity};
  return material;
}

Material with_vu(Material material) {
  material.electric = Vu{.c1 = 5e-8, .c2 = 1e-9, .eps0 = test::eps0_si};
  return material;
}

struct Strained {
  double along = 0.0;    ///< stretch along the field
  double lateral = 0.0;  ///< stretch across
  double spread = 0.0;   ///< largest distance of a node from the homogeneous deformation
  double force = 0.0;    ///< force of the solid on the face z = 1, along z
};

struct Swept {
  SweepResult result;
  Strained last;
};

Swept sweep(const test::SolidSystem& system, double field, int steps = 8) {
  const auto model = test::make_model(system);
  statics::StaticState state = test::static_start(*model);
  statics::Sweep sweep(*model, {0.0}, {1.0}, {.from = 0.0, .to = field, .steps = steps});
  Swept swept;
  const int corner = system.node_at({1, 1, 1});
  swept.result = sweep.run(state, {.record = [&](const statics::SweepPoint& at) {
                             Strained& last = swept.last;
                             last = {.along = at.q[3 * corner + 2], .lateral = at.q[3 * corner]};
                             for (int n = 0; n < system.n_nodes(); ++n) {
                               const Eigen::Vector3d stretch(last.lateral, last.lateral, last.along);
                               const Eigen::Vector3d wanted = stretch.cwiseProduct(system.node(n));
                               last.spread = std::max(last.spread, (at.q.segment<3>(3 * n) - wanted).norm());
                             }
                             for (const int n : system.nodes(test::plane(2, 1.0))) last.force += at.force[3 * n + 2];
                           }});
  return swept;
}

Strained strained(const test::SolidSystem& system, double field) {
  const Swept swept = sweep(system, field);
  EXPECT_EQ(swept.result.end, SweepResult::End::completed) << swept.result.sentence;
  EXPECT_LT(swept.last.spread, 1e-10);
  return swept.last;
}

// All numbers: numerics 3.1, twelve digits.
TEST(HomogeneousSolid, BonetWoodStrainsAsInClosedForm) {
  struct Case {
    double lambda, field, along, lateral;
  };
  const Formulation I = Formulation::displacement;
  for (const Case& at :
       {Case{10.0, 1e4, 0.995286518416, 1.00239205086}, Case{10.0, 3e4, 0.953815631753, 1.02417056003},
        Case{999.8, 1e4, 0.99526877817, 1.00237431197}, Case{999.8, 3e4, 0.953656047401, 1.02401231034}}) {
    const Strained cube_at = strained(cube(with_ideal(test::rubber(0.233, at.lambda, I)), 0.233, I), at.field);
    EXPECT_NEAR(cube_at.along, at.along, 1e-10) << at.lambda;
    EXPECT_NEAR(cube_at.lateral, at.lateral, 1e-10) << at.lambda;
  }
  for (const Case& at :
       {Case{10.0, 6e3, 0.913042644524, 1.04541474562}, Case{999.8, 6e3, 0.913689475368, 1.04615479775}}) {
    const Strained cube_at = strained(cube(with_vu(test::rubber(0.233, at.lambda, I)), 0.233, I), at.field);
    EXPECT_NEAR(cube_at.along, at.along, 1e-10) << at.lambda;
    EXPECT_NEAR(cube_at.lateral, at.lateral, 1e-10) << at.lambda;
  }
}

TEST(HomogeneousSolid, IncompressibleIdealDielectricStrainsAsInClosedForm) {
  struct Case {
    double mu, field, along;
  };
  for (const Case& at :
       {Case{0.2, 1e4, 0.994479175036}, Case{0.2, 3e4, 0.945035322222}, Case{0.2, 5e4, 0.780380936385},
        Case{0.7 / 3, 1e4, 0.995275419992}, Case{0.7 / 3, 4e4, 0.909804644007}, Case{0.7 / 3, 5e4, 0.833389955634}}) {
    for (const Formulation formulation : {Formulation::incompressible, Formulation::incompressible_direct}) {
      const auto system = cube(with_ideal(test::rubber(at.mu, 0.0, formulation)), at.mu, formulation);
      const Strained cube_at = strained(system, at.field);
      EXPECT_NEAR(cube_at.along, at.along, 1e-10) << at.mu << ' ' << at.field;
      EXPECT_NEAR(cube_at.along * cube_at.lateral * cube_at.lateral, 1.0, 1e-12);
    }
  }
}

TEST(HomogeneousSolid, IncompressibleVuStrainsAsInClosedForm) {
  struct Case {
    double field, along;
  };
  for (const Case& at : {Case{6e3, 0.913696123658}, Case{1e4, 0.81210157033}, Case{2e4, 0.603567796926}}) {
    const Formulation III = Formulation::incompressible;
    EXPECT_NEAR(strained(cube(with_vu(test::rubber(0.233, 0.0, III)), 0.233, III), at.field).along, at.along, 1e-10);
  }
}

// Both stresses vanish: mu J^(-2/3) (L_i^2 - I/3) + U' J +- eps/2 J E^2/L^2 with I = 2 a^2 + L^2, U' = kappa (J - 1).
TEST(HomogeneousSolid, MeanDilatationIsFreeOfStress) {
  const Formulation II = Formulation::mean_dilatation;
  const double mu = 0.233;
  for (const double lambda : {10.0, 999.8}) {
    const double field = 3e4;
    const Strained at = strained(cube(with_ideal(test::rubber(mu, lambda, II)), mu, II), field);
    const double L2 = at.along * at.along;
    const double a2 = at.lateral * at.lateral;
    const double J = at.along * a2;
    const double third = (2.0 * a2 + L2) / 3.0;
    const double maxwell = 0.5 * permittivity * J * field * field / L2;
    const double volume = (lambda + 2.0 / 3.0 * mu) * (J - 1.0) * J;
    const double factor = mu * std::pow(J, -2.0 / 3.0);
    EXPECT_NEAR(factor * (L2 - third) + volume + maxwell, 0.0, 1e-9 * mu * std::max(1.0, lambda));
    EXPECT_NEAR(factor * (a2 - third) + volume - maxwell, 0.0, 1e-9 * mu * std::max(1.0, lambda));
    EXPECT_LT(at.along, 0.96);
  }
}

// Numerics 3.2, of a round section of diameter 10 mm.
TEST(HomogeneousSolid, BlockedForceIsThatOfTheClosedForm) {
  const Formulation III = Formulation::incompressible;
  const double area = 25.0 * std::numbers::pi;
  auto ideal = cube(with_ideal(test::rubber(0.233, 0.0, III)), 0.233, III);
  ideal.hold(test::plane(2, 1.0), 2);
  EXPECT_NEAR(-area * strained(ideal, 20e3).force, 1.02920271792, 1e-9);
  EXPECT_NEAR(-area * strained(ideal, 30e3).force, 2.31570611531, 1e-9);
  auto legacy = cube(with_vu(test::rubber(0.233, 0.0, III)), 0.233, III);
  legacy.hold(test::plane(2, 1.0), 2);
  EXPECT_NEAR(-area * strained(legacy, 20e3).force, 63.1100159685, 1e-8);
}

// E* = 58009.6395041 V/mm for mu 0.7/3 and relative permittivity 3.7 (numerics 3.1); at .999 E* the stretch is the
// stable root of L^4 - L + eps E^2/mu.
TEST(HomogeneousSolid, PullInIsLostAtTheCriticalField) {
  const double critical = 58009.6395041;
  const double mu = 0.7 / 3;
  const Formulation III = Formulation::incompressible;
  const auto system = cube(with_ideal(test::rubber(mu, 0.0, III)), mu, III);
  const SweepResult lost = sweep(system, 6.5e4, 13).result;
  EXPECT_EQ(lost.end, SweepResult::End::loss_of_equilibrium) << lost.sentence;
  EXPECT_NEAR(lost.last_good, critical, 1e-3 * critical);
  EXPECT_NEAR(lost.first_bad, critical, 1e-3 * critical);
  EXPECT_LE(lost.last_good, critical);
  const double beta = permittivity * std::pow(0.999 * critical, 2) / mu;
  double root = 1.0;
  for (int k = 0; k < 50; ++k) root -= (std::pow(root, 4) - root + beta) / (4.0 * std::pow(root, 3) - 1.0);
  EXPECT_NEAR(strained(system, 0.999 * critical).along, root, 1e-8);
  EXPECT_EQ(sweep(system, 1.001 * critical).result.end, SweepResult::End::loss_of_equilibrium);
}

}  // namespace
}  // namespace muldi::fem
