/// Layers whose permittivities differ ten thousandfold under the edge of an electrode (numerics 5 no. 31).
#include <gtest/gtest.h>

#include <vector>

#include "support/figure.hpp"
#include "support/solid_system.hpp"
#include "support/trajectory.hpp"

namespace muldi::fem {
namespace {

using Eigen::Vector3d;

constexpr double mu = 0.233;
constexpr double low = 2.0 * test::eps0_si;

/// A cube whose lower half has 1e4 times the permittivity of the upper one, with an electrode on a half of its top.
test::SolidSystem layered(int n, double voltage) {
  test::SolidSystem system = test::solid_box({n, n, n}, {0, 0, 0}, {1, 1, 1});
  system.hold_lower_faces();
  system.set_potential(test::plane(2, 0.0), {});
  system.set_potential([](const Vector3d& X) { return X[2] > 1 - 1e-9 && X[0] < 0.5 + 1e-9; }, {.constant = voltage});
  Material material = test::rubber(mu, 10.0, Formulation::mean_dilatation);
  material.electric = IdealDielectric{.permittivity = 1e4 * low};
  material.viscous = KelvinVoigt{.viscosity = 0.05};
  system.fill(material, mu, Formulation::mean_dilatation);
  material.electric = IdealDielectric{.permittivity = low};
  system.solid.materials.push_back(material);
  system.solid.shear_moduli.push_back(mu);
  const std::size_t half = system.solid.cells.size() / 2;  // cells go up in z
  std::fill(system.solid.material_of_cell.begin() + static_cast<std::ptrdiff_t>(half),
            system.solid.material_of_cell.end(), 1);
  return system;
}

/// 1/2 C U^2 of the undeformed cube.
double stored_energy(int n) {
  const test::SolidSystem system = layered(n, 1e3);
  const auto model = test::make_model(system);
  const Solid& solid = test::solid_in(*model);
  const Eigen::VectorXd phi = solid.potentials_at(system.solid.X, {});
  return -solid.elements().energies({.x = system.solid.X.data(), .phi = phi.data()}).electric;
}

TEST(FieldContrast, TheEnergyFallsMonotonicallyUnderRefinement) {
  // Dirichlet's principle: the energy is the least over all potentials with these voltages, and a finer mesh of cubes
  // holds the potentials of the coarser one.
  std::vector<double> energies;
  for (const int n : {2, 4, 8, 16}) energies.push_back(stored_energy(n));
  EXPECT_GT(energies.back(), 0.0);
  for (std::size_t k = 0; k + 1 < energies.size(); ++k) {
    test::record_at_least("31", "fall of the energy under halving, of 1", 1.0 - energies[k + 1] / energies[k], 0.0);
  }
  const double first = energies[1] - energies[2];
  const double second = energies[2] - energies[3];
  test::record_figure("31", "fall of the energy over the one before", second / first, 1.0);
}

TEST(FieldContrast, TheEnergyIsHalfOfChargeTimesVoltage) {
  const double voltage = 1e3;
  const test::SolidSystem system = layered(8, voltage);
  const auto model = test::make_model(system);
  const Solid& solid = test::solid_in(*model);
  const Eigen::VectorXd phi = solid.potentials_at(system.solid.X, {});
  const Eigen::VectorXd charge = -solid.charge_rows(system.solid.X, phi);
  double sum = 0.0;
  for (const PrescribedPotential& at : system.solid.potentials) {
    if (at.value.constant != 0.0) sum += charge[at.node];
  }
  const double energy = -solid.elements().energies({.x = system.solid.X.data(), .phi = phi.data()}).electric;
  test::record_near("31", "charge of the electrode times voltage over twice the energy", sum * voltage / (2.0 * energy),
                    1.0, 1e-10);
}

TEST(FieldContrast, TheCoupledMotionStaysFinite) {
  const test::SolidSystem system = layered(4, 1.2e4);
  const auto model = test::make_model(system);
  statics::StaticState rest = test::static_start(*model);
  const statics::EquilibriumReport report = statics::EquilibriumSolver(*model, {}).solve(rest, {});
  ASSERT_TRUE(report.converged) << report.inadmissible;
  EXPECT_TRUE(rest.q.allFinite());
  EXPECT_TRUE(rest.y.allFinite());
  const double dt = 0.01;
  bool finite = true;
  double moved = 0.0;
  const test::Run done = test::run(*model, test::moving_state(*model, dt), {.dt = dt, .steps = 100},
                                   [&](const variational::NodeRecord& node) {
                                     finite = finite && node.state.q.allFinite() && node.state.y.allFinite();
                                     moved = (node.state.q - system.solid.X).lpNorm<Eigen::Infinity>();
                                   });
  ASSERT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
  EXPECT_TRUE(finite);
  test::record_at_least("31", "displacement under a voltage, of the side", moved, 1e-3);
}

}  // namespace
}  // namespace muldi::fem
