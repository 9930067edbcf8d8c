/// What a solid does at the limits of its formulation: locking, collapse, closed boxes; reactions balance the loads.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "statics/sweep.hpp"
#include "support/figure.hpp"
#include "support/solid_cubes.hpp"
#include "variational/stepper.hpp"

namespace muldi::fem {
namespace {

using Eigen::Vector3d;

constexpr double mu = test::cube_mu;

double lambda_of(double nu) { return 2.0 * mu * nu / (1.0 - 2.0 * nu); }

/// A bar 10 x 2 x 2 clamped at x = 0 with a dead load along z on its end.
test::SolidSystem cantilever(double load, double nu, Formulation formulation) {
  test::SolidSystem system = test::solid_box({10, 2, 2}, {0, 0, 0}, {10, 2, 2});
  for (int i = 0; i < 3; ++i) system.hold(test::plane(0, 0.0), i);
  DeadLoad end{.nodes = system.nodes(test::plane(0, 10.0)), .unit = {}, .value = {.constant = load}};
  end.unit.assign(end.nodes.size(), Vector3d(0, 0, 1.0 / static_cast<double>(end.nodes.size())));
  system.solid.dead_loads.push_back(end);
  system.fill(test::rubber(mu, lambda_of(nu), formulation), mu, formulation);
  return system;
}

struct Bent {
  double tip = 0.0;
  Vector3d reaction = Vector3d::Zero();
};

Bent bent(double load, double nu, Formulation formulation) {
  const test::SolidSystem system = cantilever(load, nu, formulation);
  const auto model = test::make_model(system);
  statics::StaticState state = test::static_start(*model);
  statics::EquilibriumSolver solver(*model, {});
  const statics::EquilibriumReport report = solver.solve(state, {});
  EXPECT_TRUE(report.converged) << report.inadmissible;
  EXPECT_EQ(report.stability, statics::Stability::stable);
  solver.linearise(state, {});
  Bent result{.tip = state.q[3 * system.node_at({10, 1, 1}) + 2] - 1.0};
  for (const int n : system.nodes(test::plane(0, 0.0))) result.reaction -= solver.force().segment<3>(3 * n);
  return result;
}

TEST(SolidLimits, DisplacementsAloneLockAndMeanDilatationTendsToTheIncompressibleLimit) {
  const double load = 1e-3;
  const double limit = bent(load, 0.0, Formulation::incompressible).tip;
  EXPECT_GT(limit, 0.1);
  double gap = 1.0;
  for (const double nu : {0.49, 0.499, 0.4999}) {
    const double next = std::abs(bent(load, nu, Formulation::mean_dilatation).tip / limit - 1.0);
    EXPECT_LT(next, 0.2 * gap) << nu;
    gap = next;
  }
  EXPECT_LT(gap, 0.01);  // numerics 5 no. 12
  EXPECT_LT(bent(load, 0.4999, Formulation::displacement).tip, 0.5 * limit);
}

TEST(SolidLimits, ReactionsBalanceTheLoad) {
  const double load = 1e-3;
  for (const Formulation formulation : test::formulations) {
    EXPECT_LT((bent(load, 0.499, formulation).reaction - Vector3d(0, 0, -load)).norm(), 1e-10 * load);
  }
}

/// A cube of two cells a side, pressed down on its top.
test::SolidSystem pressed(double load, Formulation formulation) {
  test::SolidSystem system = test::solid_box({2, 2, 2}, {0, 0, 0}, {1, 1, 1});
  system.hold_lower_faces();
  const fem::Value value = system.control(load);
  DeadLoad top{.nodes = system.nodes(test::plane(2, 1.0)), .unit = {}, .value = value};
  top.unit.assign(top.nodes.size(), Vector3d(0, 0, -1.0 / static_cast<double>(top.nodes.size())));
  system.solid.dead_loads.push_back(top);
  system.fill(test::rubber(mu, 10.0, formulation), mu, formulation);
  return system;
}

TEST(SolidLimits, AnInvertedStartNamesItsCell) {
  const test::SolidSystem system = pressed(0.0, Formulation::displacement);
  const auto model = test::make_model(system);
  statics::StaticState state = test::static_start(*model);
  // 1.3 down: det F - 1 = -1.3 dN/dz = -1.3 ((1 + 1/sqrt 3)/2)^2/0.5 at the nearest Gauss point.
  state.q[3 * system.node_at({1, 1, 1}) + 2] = -0.3;
  EXPECT_EQ(model->inadmissible_anywhere(state.q),
            "solid 'box': cell 7 at [0.75, 0.75, 0.75] is inverted (det F -0.617)");
  const statics::EquilibriumReport report =
      statics::EquilibriumSolver(*model, {}).solve(state, std::vector<double>{0.0});
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.inadmissible, "solid 'box': cell 7 at [0.75, 0.75, 0.75] is inverted (det F -0.617)");
}

TEST(SolidLimits, ALoadTooLargeForOneStepLeavesTheStateAndIsReported) {
  const test::SolidSystem system = pressed(1e3, Formulation::displacement);
  const auto model = test::make_model(system);
  statics::StaticState state = test::static_start(*model);
  const Eigen::VectorXd start = state.q;
  const statics::EquilibriumReport report =
      statics::EquilibriumSolver(*model, {}).solve(state, std::vector<double>{1e3});
  EXPECT_FALSE(report.converged);
  EXPECT_TRUE(state.q == start);
  test::record_figure("10", "state after a refused step into inverted cells, difference from its start (mm)",
                      (state.q - start).lpNorm<Eigen::Infinity>(), 0.0);

  statics::Sweep sweep(*model, {0.0}, {1.0}, {.from = 1e3, .to = 2e3, .steps = 2});
  const statics::SweepResult result = sweep.run(state, {});
  EXPECT_EQ(result.end, statics::SweepResult::End::loss_of_equilibrium);
  // How far beyond zero the last iterate is depends on round-off.
  const std::string said =
      "no stable equilibrium at the first load: the forces move on until solid 'box': cell 7 at [0.75, 0.75, 0.75] "
      "is inverted (det F -0.08";
  EXPECT_EQ(result.sentence.substr(0, said.size()), said) << result.sentence;
}

TEST(SolidLimits, AnEquilibriumHoldsWhatIsPrescribed) {
  test::SolidSystem system = test::solid_box({2, 2, 2}, {0, 0, 0}, {1, 1, 1});
  system.hold_lower_faces();
  const fem::Value value = system.control(0.0);
  system.hold(test::plane(0, 1.0), 0, value);
  system.set_potential(test::plane(2, 0.0), {});
  system.set_potential(test::plane(2, 1.0), value);
  fem::Material material = test::rubber(mu, 10.0, Formulation::displacement);
  material.electric = fem::IdealDielectric{.permittivity = 3e-11};
  system.fill(material, mu, Formulation::displacement);
  const auto model = test::make_model(system);
  statics::StaticState state = test::static_start(*model);
  ASSERT_TRUE(statics::EquilibriumSolver(*model, {}).solve(state, std::vector<double>{0.25}).converged);
  const int corner = system.node_at({1, 1, 1});
  EXPECT_DOUBLE_EQ(state.q[3 * corner], 1.25);
  EXPECT_DOUBLE_EQ(state.y[corner], 0.25);
}

TEST(SolidLimits, AColumnBucklesAtEulersLoad) {
  const int n = 2;
  test::SolidSystem system = test::solid_box({n, n, 12 * n}, {0, 0, 0}, {1, 1, 12});
  for (int i = 0; i < 3; ++i) system.hold(test::plane(2, 0.0), i);
  DeadLoad top{.nodes = system.nodes(test::plane(2, 12.0)), .unit = {}, .value = system.control(0.0)};
  for (const int node : top.nodes) {
    const auto share = [](double at) { return (at > 1e-9 && at < 1.0 - 1e-9 ? 1.0 : 0.5) / n; };
    top.unit.push_back({0, 0, -share(system.node(node)[0]) * share(system.node(node)[1])});
  }
  system.solid.dead_loads.push_back(top);
  system.fill(test::rubber(mu, 0.0, Formulation::incompressible), mu, Formulation::incompressible);
  const auto model = test::make_model(system);
  statics::StaticState state = test::static_start(*model);
  statics::Sweep sweep(*model, {0.0}, {1.0}, {.from = 0.0, .to = 3e-3, .steps = 6});
  const statics::SweepResult result = sweep.run(state, {});
  EXPECT_EQ(result.end, statics::SweepResult::End::loss_of_equilibrium) << result.sentence;
  EXPECT_LT(result.first_bad - result.last_good, 1e-6 * 3e-3);
  // pi^2 Y I/(4 l^2) with Y = 3 mu for a fixed foot; two linear cells across are 4.4 % too stiff, four 2.3 %.
  const double euler = std::pow(std::numbers::pi, 2) * 3.0 * mu / 12.0 / (4.0 * 144.0);
  EXPECT_NEAR(result.last_good, euler, 0.05 * euler);
}

TEST(SolidLimits, ABlowTooHardForTheStepInvertsCells) {
  for (const Formulation formulation : {Formulation::displacement, Formulation::incompressible}) {
    const test::SolidSystem system = pressed(1e4, formulation);
    const auto model = test::make_model(system);
    variational::State state = test::moving_state(*model, 0.1);
    variational::Stepper stepper(*model, 0.1, {});
    variational::StepReport report;
    while (state.step < 100 && report.status == variational::Status::running) {
      report = stepper.advance(state, std::vector<double>{1e4});
    }
    EXPECT_EQ(report.status, variational::Status::inverted_element) << report.sentence;
    EXPECT_TRUE(state.q.allFinite());
  }
}

/// A cube with all its walls held, pushed inside.
test::SolidSystem clamped(test::SolidSystem system, double load) {
  for (int i = 0; i < 3; ++i) system.hold(test::on_wall, i);
  const std::vector<int> inside =
      system.nodes([](const Vector3d& X) { return (X.array() - 0.5).matrix().norm() < 0.15; });
  system.solid.dead_loads.push_back({.nodes = {inside.at(0)}, .unit = {{1, 2, 3}}, .value = {.constant = load}});
  system.fill(test::rubber(mu, 0.0, Formulation::incompressible), mu, Formulation::incompressible);
  return system;
}

void expect_finite_pressures(const test::SolidSystem& system, double load) {
  const auto model = test::make_model(system);
  const Solid& solid = test::solid_in(*model);
  statics::StaticState rest = test::static_start(*model);
  statics::EquilibriumSolver solver(*model, {});
  EXPECT_TRUE(solver.solve(rest, {}).converged);
  // The load over the area that it has for itself, h^2 = 1/16, is 60 times it.
  EXPECT_GT(solid.pressures(rest.y).lpNorm<Eigen::Infinity>(), load);
  EXPECT_LT(solid.pressures(rest.y).lpNorm<Eigen::Infinity>(), 600.0 * load);
  EXPECT_LT((solid.volumes_at(rest.q).J.array() - 1.0).abs().maxCoeff(), 1e-12);
  solver.linearise(rest, {});
  for (const int n : system.nodes([](const Vector3d& X) { return !test::on_wall(X); })) {
    EXPECT_LT(solver.force().segment<3>(3 * n).norm(), 1e-6 * load);
  }
}

TEST(SolidLimits, AnIncompressibleClampedBoxHasFinitePressures) {
  // In the regular box checkerboard pressures exert no force at the reference (numerics C4b).
  expect_finite_pressures(clamped(test::solid_box({4, 4, 4}, {0, 0, 0}, {1, 1, 1}), 1e-9), 1e-9);
  expect_finite_pressures(clamped(test::solid_of(test::cube_of(4)), 1e-3), 1e-3);
}

}  // namespace
}  // namespace muldi::fem
