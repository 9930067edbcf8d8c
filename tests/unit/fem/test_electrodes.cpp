/// Potentials that are not given: floating electrodes and surface charges against capacitors in series.
#include <gtest/gtest.h>

#include "statics/equilibrium.hpp"
#include "support/solid_system.hpp"

namespace muldi::fem {
namespace {

constexpr double lower_permittivity = 3.0 * test::eps0_si;
constexpr double upper_permittivity = 7.0 * test::eps0_si;
constexpr double voltage = 5e3;
/// Capacitances of the layers z < 1 and z > 1, of section 1 mm^2.
constexpr double lower_capacitance = lower_permittivity;
constexpr double upper_capacitance = upper_permittivity / 2.0;

/// A column of section 1 and height 3 that does not deform, of two dielectrics; grounded below.
test::SolidSystem column() {
  test::SolidSystem system = test::solid_box({2, 2, 3}, {0, 0, 0}, {1, 1, 3});
  for (int i = 0; i < 3; ++i) system.hold([](const Eigen::Vector3d&) { return true; }, i);
  Material material = test::rubber(0.233, 10.0, Formulation::displacement);
  material.electric = IdealDielectric{.permittivity = lower_permittivity};
  system.fill(material, 0.233, Formulation::displacement);
  material.electric = IdealDielectric{.permittivity = upper_permittivity};
  system.solid.materials.push_back(material);
  system.solid.shear_moduli.push_back(0.233);
  for (std::size_t cell = 4; cell < 12; ++cell) system.solid.material_of_cell[cell] = 1;
  system.set_potential(test::plane(2, 0.0), {});
  return system;
}

Eigen::VectorXd potentials(const test::SolidSystem& system) {
  const auto model = test::make_model(system);
  statics::StaticState state = test::static_start(*model);
  const statics::EquilibriumReport report = statics::EquilibriumSolver(*model, {}).solve(state, {});
  EXPECT_TRUE(report.converged) << report.inadmissible;
  EXPECT_EQ(report.stability, statics::Stability::stable);
  return test::solid_in(*model).potentials(state.y);
}

TEST(FloatingElectrode, HasThePotentialOfCapacitorsInSeries) {
  for (const double charge : {0.0, 2e-8}) {
    test::SolidSystem system = column();
    system.set_potential(test::plane(2, 3.0), {.constant = voltage});
    const std::vector<int> nodes = system.nodes(test::plane(2, 1.0));
    system.solid.floating.push_back({.name = "middle", .nodes = nodes, .charge = {.constant = charge}});
    const Eigen::VectorXd phi = potentials(system);
    const double wanted = (upper_capacitance * voltage + charge) / (lower_capacitance + upper_capacitance);
    for (const int n : nodes) EXPECT_NEAR(phi[n], wanted, 1e-10 * voltage);
  }
}

TEST(SurfaceCharge, RaisesThePotentialOfCapacitorsInSeries) {
  test::SolidSystem system = column();
  const double charge = 2e-8;
  SurfaceCharge on_top{.nodes = {}, .unit = {}, .value = {.constant = charge}};
  for (const int n : system.nodes(test::plane(2, 3.0))) {
    const Eigen::Vector3d X = system.node(n);
    const auto share = [](double at) { return at > 0.1 && at < 0.9 ? 0.5 : 0.25; };
    on_top.nodes.push_back(n);
    on_top.unit.push_back(share(X[0]) * share(X[1]));
  }
  system.solid.surface_charges.push_back(on_top);
  const Eigen::VectorXd phi = potentials(system);
  for (const int n : on_top.nodes) {
    EXPECT_NEAR(phi[n], charge / lower_capacitance + charge / upper_capacitance, 1e-10 * voltage);
  }
  for (const int n : system.nodes(test::plane(2, 1.0)))
    EXPECT_NEAR(phi[n], charge / lower_capacitance, 1e-10 * voltage);
}

}  // namespace
}  // namespace muldi::fem
