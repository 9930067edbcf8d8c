/// The potential has no inertia and must not ring: no zig-zag under steps of the voltage (numerics 5 no. 7, C2).
#include <gtest/gtest.h>

#include <iostream>

#include "support/figure.hpp"
#include "support/solid_system.hpp"
#include "support/trajectory.hpp"
#include "variational/stepper.hpp"

namespace muldi::fem {
namespace {

using Eigen::VectorXd;

/// A cube with an electrode on a part of its top, whose voltage changes every ten steps.
test::SolidSystem switched(double dt) {
  test::SolidSystem system = test::solid_of(test::cube_of(3));
  system.hold_lower_faces();
  base::Samples steps;
  for (int k = 0; k < 100; ++k) {
    steps.times.push_back(10 * dt * k);
    steps.values.push_back(k % 2 == 0 ? 1e4 : 1.5e4);
  }
  system.set_potential(test::plane(2, 0.0), {});
  system.set_potential([](const Eigen::Vector3d& X) { return X[2] > 1 - 1e-9 && X[0] < 0.5; },
                       system.control(base::TimeFunction(base::TimeFunction::Kind(steps))));
  Material material = test::rubber(0.233, 10.0, Formulation::displacement);
  material.electric = IdealDielectric{.permittivity = 3.7 * test::eps0_si};
  material.viscous = KelvinVoigt{.viscosity = 0.05};
  system.fill(material, 0.233, Formulation::displacement);
  return system;
}

struct Motion {
  std::vector<VectorXd> potentials;  ///< one a step
  VectorXd q;
  double charge_left = 0.0;  ///< largest row of a node without voltage in any step, over the largest with one
};

Motion motion(double dt, long steps, double disturbance) {
  const test::SolidSystem system = switched(dt);
  const auto model = test::make_model(system);
  variational::State state = test::moving_state(*model, dt);
  std::mt19937 random(7);
  state.y += test::random_values(random, state.y.size(), disturbance);
  variational::Stepper stepper(*model, dt, {.tolerance = 1e-11});
  const Solid& solid = test::solid_in(*model);
  std::vector<bool> has_voltage(static_cast<std::size_t>(system.n_nodes()), false);
  for (const PrescribedPotential& at : system.solid.potentials) has_voltage[static_cast<std::size_t>(at.node)] = true;
  std::vector<double> u(1);
  Motion all;
  VectorXd before = state.q;
  while (state.step < steps) {
    model->evaluate_controls((static_cast<double>(state.step) + 0.5) * dt, u);
    const variational::StepReport report = stepper.advance(state, u);
    EXPECT_EQ(report.status, variational::Status::running) << report.sentence;
    if (report.status != variational::Status::running) break;
    all.potentials.push_back(state.y);
    const VectorXd rows = solid.charge_rows(0.5 * (before + state.q), solid.potentials(state.y));
    before = state.q;
    double free = 0.0;
    double held = 0.0;
    for (int n = 0; n < system.n_nodes(); ++n) {
      double& largest = has_voltage[static_cast<std::size_t>(n)] ? held : free;
      largest = std::max(largest, std::abs(rows[n]));
    }
    all.charge_left = std::max(all.charge_left, free / held);
  }
  all.q = state.q;
  return all;
}

/// Largest second difference of the potentials between two voltage changes in [first, last).
double zigzag(const Motion& of, std::size_t first, std::size_t last) {
  double largest = 0.0;
  for (std::size_t n = first; n + 2 < last; ++n) {
    if (n % 10 > 7) continue;
    const VectorXd second = of.potentials[n + 2] - 2.0 * of.potentials[n + 1] + of.potentials[n];
    largest = std::max(largest, second.lpNorm<Eigen::Infinity>());
  }
  return largest;
}

TEST(SolidPotentials, DoNotZigzagUnderStepsOfTheVoltage) {
  const Motion at = motion(2e-3, 1000, 0.0);
  ASSERT_EQ(at.potentials.size(), 1000u);
  const double early = zigzag(at, 0, 100);
  const double late = zigzag(at, 900, 1000);
  test::record_figure("7", "zig-zag of potentials under voltage steps, last 100 steps over first 100", late / early,
                      1.0);
  test::record_figure("7", "zig-zag of potentials under voltage steps, over the voltage", early / 1.5e4, 1e-3);
  EXPECT_GT(early, 0.0);
  test::record_figure("7", "charge left at nodes without voltage in any step, over that of the electrode",
                      at.charge_left, 1e-11);
  std::cout << "zig-zag of the potentials: " << early << " V early, " << late << " V late\n";
}

TEST(SolidPotentials, ForgetADisturbedStart) {
  const Motion calm = motion(2e-3, 100, 0.0);
  const Motion disturbed = motion(2e-3, 100, 1e-3 * 1.5e4);
  test::record_figure("7", "motion after a start disturbed by 1e-3, difference (mm of 1 mm)",
                      (calm.q - disturbed.q).lpNorm<Eigen::Infinity>(), 1e-9);
  double largest = 0.0;
  for (std::size_t n = 0; n < calm.potentials.size(); ++n) {
    largest = std::max(largest, (calm.potentials[n] - disturbed.potentials[n]).lpNorm<Eigen::Infinity>());
  }
  test::record_figure("7", "potentials after a start disturbed by 1e-3, difference over the voltage", largest / 1.5e4,
                      1e-8);
}

}  // namespace
}  // namespace muldi::fem
