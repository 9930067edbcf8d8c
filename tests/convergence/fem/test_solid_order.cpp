/// The step of solids is of order 2 in time: positions, momenta, pressures, energy; a membrane of one element moves as
/// the lumped one (numerics 3.8, 5 nos. 3, 24, 27).
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>
#include <stdexcept>

#include "support/figure.hpp"
#include "support/solid_system.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi::fem {
namespace {

using Eigen::VectorXd;

/// A distorted cube on symmetry planes; a voltage that rises smoothly from zero, lower on one half of the top.
test::SolidSystem actuated(Formulation formulation, double viscosity) {
  test::SolidSystem system = test::solid_of(test::cube_of(2));
  system.hold_lower_faces();
  const base::Sine rise{.amplitude = 1e4, .frequency = 2.0, .phase = -0.5 * std::numbers::pi, .offset = 1e4};
  system.set_potential(test::plane(2, 0.0), {});
  system.set_potential([](const Eigen::Vector3d& X) { return X[2] > 1 - 1e-9 && X[0] < 0.8; },
                       system.control(base::TimeFunction(base::TimeFunction::Kind(rise))));
  Material material = test::rubber(0.233, 10.0, formulation);
  material.electric = IdealDielectric{.permittivity = 3.7 * test::eps0_si};
  if (viscosity > 0.0) material.viscous = KelvinVoigt{.viscosity = viscosity};
  system.fill(material, 0.233, formulation);
  return system;
}

struct Sample {
  VectorXd q, momentum, pressures;
  double imbalance = 0.0;  ///< of the power balance
};

Sample sample(const test::SolidSystem& system, const test::RunSetup& setup) {
  const auto model = test::make_model(system);
  const Solid& solid = test::solid_in(*model);
  Sample at;
  // One step more: the pressures of a node belong to the step that follows it.
  const test::RunSetup longer{.dt = setup.dt, .steps = setup.steps + 1, .step = setup.step};
  const test::Run run =
      test::run(*model, test::moving_state(*model, setup.dt), longer, [&](const variational::NodeRecord& node) {
        if (node.step != setup.steps) return;
        at.q = node.state.q;
        at.momentum = node.values.momentum;
        at.pressures = solid.pressures(node.y_after);
        if (solid.is_incompressible()) return;
        // Those of mean dilatation belong to the middles of the intervals.
        at.pressures = 0.5 * (at.pressures + solid.pressures(node.state.y));
      });
  if (run.result.status != variational::Status::completed) throw std::runtime_error(run.result.sentence);
  return at;
}

void expect_order_two(Formulation formulation, double viscosity, const test::RunSetup& setup) {
  const test::SolidSystem system = actuated(formulation, viscosity);
  std::array<Sample, 4> at;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const long factor = 1L << k;
    at[k] = sample(system,
                   {.dt = setup.dt / static_cast<double>(factor), .steps = setup.steps * factor, .step = setup.step});
  }
  const auto order = [&](VectorXd Sample::*value) {
    const auto slope = [&](std::size_t k) {
      return std::log2((at[k].*value - at[k + 1].*value).norm() / (at[k + 1].*value - at[k + 2].*value).norm());
    };
    return std::abs(slope(0) - 2.0) > std::abs(slope(1) - 2.0) ? slope(0) : slope(1);
  };
  const double of_q = order(&Sample::q);
  const double of_p = order(&Sample::momentum);
  test::record_near("3", "solids, order of positions", of_q, 2.0, 0.05);
  test::record_near("3", "solids, order of momenta", of_p, 2.0, 0.05);
  std::cout << "orders: q " << of_q << ", p " << of_p;
  if (formulation != Formulation::displacement) {
    const double of_pressures = order(&Sample::pressures);
    test::record_near("3", "solids, order of pressures", of_pressures, 2.0, 0.05);
    std::cout << ", pressures " << of_pressures;
  }
  std::cout << ", |dq| " << (at[1].q - at[2].q).norm() << ", moved " << (at[2].q - system.solid.X).norm() << '\n';
}

const variational::StepOptions exact = {.tolerance = 1e-12};

TEST(SolidOrder, IsTwoForDisplacements) {
  for (const double viscosity : {0.0, 0.05}) {
    expect_order_two(Formulation::displacement, viscosity, {.dt = 1e-3, .steps = 150, .step = exact});
  }
}

TEST(SolidOrder, IsTwoForMeanDilatation) {
  for (const double viscosity : {0.0, 0.05}) {
    expect_order_two(Formulation::mean_dilatation, viscosity, {.dt = 1e-3, .steps = 150, .step = exact});
  }
}

TEST(SolidOrder, IsTwoForExactIncompressibility) {
  for (const double viscosity : {0.0, 0.05}) {
    for (const Formulation formulation : {Formulation::incompressible, Formulation::incompressible_direct}) {
      expect_order_two(formulation, viscosity, {.dt = 2e-3, .steps = 75, .step = exact});
    }
  }
}

/// An eighth of the membrane 20 x 20 x 1 of numerics 3.8 as one element.
test::SolidSystem membrane(double field = 3e4, double viscosity = 0.01) {
  test::SolidSystem system = test::solid_box({1, 1, 1}, {0, 0, 0}, {10, 10, 0.5});
  system.hold_lower_faces();
  system.set_potential(test::plane(2, 0.0), {});
  system.set_potential(test::plane(2, 0.5), {.constant = 0.5 * field});
  Material material = test::rubber(0.7 / 3, 0.0, Formulation::incompressible);
  material.electric = IdealDielectric{.permittivity = 3.7 * test::eps0_si};
  if (viscosity > 0.0) material.viscous = KelvinVoigt{.viscosity = viscosity};
  system.fill(material, 0.7 / 3, Formulation::incompressible);
  return system;
}

/// Thickness (mm) of the membrane at every node in time.
std::vector<double> thickness(const model::Model& model, const variational::State& start, Eigen::Index index,
                              double factor, const test::RunSetup& setup) {
  std::vector<double> z;
  const test::Run run = test::run(
      model, start, setup, [&](const variational::NodeRecord& node) { z.push_back(factor * node.state.q[index]); });
  if (run.result.status != variational::Status::completed) throw std::runtime_error(run.result.sentence);
  return z;
}

std::vector<double> solid_thickness(const test::RunSetup& setup) {
  const test::SolidSystem system = membrane();
  const auto model = test::make_model(system);
  return thickness(*model, test::moving_state(*model, setup.dt), 3 * system.node_at({0, 0, 0.5}) + 2, 2.0, setup);
}

std::vector<double> lumped_thickness(const test::RunSetup& setup) {
  const auto model = test::make_model(test::membrane(3e4, 0.01));
  return thickness(*model, test::state_at_rest(*model), 0, 1.0, setup);
}

// Two discretisations in time of one equation: 1.6e-6 at dt .01, a quarter at half the step (numerics 5 no. 27).
TEST(SolidMembrane, MovesAsTheLumpedOne) {
  double gaps[2];
  for (int k = 0; k < 2; ++k) {
    const test::RunSetup setup{.dt = 0.01 / (k + 1), .steps = 500 * (k + 1), .step = exact};
    const std::vector<double> solid = solid_thickness(setup);
    const std::vector<double> lumped = lumped_thickness(setup);
    gaps[k] = 0.0;
    for (std::size_t n = 0; n < solid.size(); ++n) gaps[k] = std::max(gaps[k], std::abs(solid[n] / lumped[n] - 1.0));
  }
  std::cout << "FE against lumped: " << gaps[0] << ", " << gaps[1] << '\n';
  test::record_figure("27", "membrane, one element against the lumped muscle, dt 0.01 ms, relative", gaps[0], 2e-6);
  test::record_figure("27", "membrane, one element against the lumped muscle, dt 0.005 ms, relative", gaps[1], 1e-6);
  test::record_near("27", "membrane, one element against the lumped muscle, ratio on halving", gaps[0] / gaps[1], 4.0,
                    0.2);
}

// z(0.5) = 0.91857712354, z(5) = 0.95042903748 mm by a Runge-Kutta method of order 8 at tolerance 1e-13 (numerics 3.8).
TEST(SolidMembrane, TendsToTheExactMotion) {
  std::vector<double> z[3];
  for (int k = 0; k < 3; ++k) z[k] = solid_thickness({.dt = 0.01 / (1 << k), .steps = 500L << k, .step = exact});
  const double exact_z[2] = {0.91857712354, 0.95042903748};
  for (int i = 0; i < 2; ++i) {
    double at[3];
    for (int k = 0; k < 3; ++k) at[k] = z[k][static_cast<std::size_t>((i == 0 ? 50 : 500) << k)];
    const double limit = test::extrapolated(at[1], at[2]);
    std::cout << "errors: " << at[0] - exact_z[i] << ", " << at[1] - exact_z[i] << ", " << at[2] - exact_z[i]
              << ", extrapolated " << limit - exact_z[i] << '\n';
    EXPECT_NEAR((at[1] - exact_z[i]) / (at[2] - exact_z[i]), 4.0, 0.2);
    EXPECT_NEAR(limit, exact_z[i], 1e-8);
  }
}

// A step of the voltage from rest without viscosity: E_dyn = 54601.6995073 V/mm, where the motion turns at the stretch
// 0.465571231877 (numerics 3.1, by energy).
TEST(SolidMembrane, IsPulledInAtTheDynamicCriticalField) {
  const auto least_stretch = [](double field) {
    const test::SolidSystem system = membrane(field, 0.0);
    const auto model = test::make_model(system);
    const int above = system.node_at({0, 0, 0.5});
    double least = 1.0;
    test::run(*model, test::moving_state(*model, 2e-3), {.dt = 2e-3, .steps = 2000},
              [&](const variational::NodeRecord& node) { least = std::min(least, 2.0 * node.state.q[3 * above + 2]); });
    return least;
  };
  const double critical = 54601.6995073;
  EXPECT_GT(least_stretch(0.999 * critical), 0.465571231877);
  EXPECT_LT(least_stretch(1.001 * critical), 0.3);
}

}  // namespace
}  // namespace muldi::fem
