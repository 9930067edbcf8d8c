/// Frequencies of small vibrations of a column against the discrete closed form (numerics 3.6).
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "support/solid_system.hpp"
#include "support/trajectory.hpp"

namespace muldi::fem {
namespace {

constexpr double density = 1e-3;

/// A column of n cells along x, fixed at x = 0 and held laterally.
test::SolidSystem column(int n, double length, const Material& material, Formulation formulation) {
  test::SolidSystem system = test::solid_box({n, 1, 1}, {0, 0, 0}, {length, 1, 1});
  system.hold(test::plane(0, 0.0), 0);
  for (int i = 1; i < 3; ++i) system.hold([](const Eigen::Vector3d&) { return true; }, i);
  system.fill(material, 0.233, formulation);
  return system;
}

/// Angular frequency of the first mode, from the three-term recurrence of its motion at the end of the column.
double frequency(const test::SolidSystem& system, double length, double dt) {
  const auto model = test::make_model(system);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(system.solid.X.size());
  // The mode of equal cells is a sine at the nodes; small, so that the motion is linear.
  for (int k = 0; k < system.n_nodes(); ++k) {
    v[3 * k] = 1e-6 * std::sin(0.5 * std::numbers::pi * system.node(k)[0] / length);
  }
  const int end = system.node_at({length, 0, 0});
  std::vector<double> moved;
  test::run(*model, test::moving_state(*model, dt, v), {.dt = dt, .steps = 40, .step = {.tolerance = 1e-14}},
            [&](const variational::NodeRecord& node) { moved.push_back(node.state.q[3 * end] - length); });
  // q_(n+1) + q_(n-1) = 2 cos(theta) q_n, by least squares; omega dt/2 = tan(theta/2).
  double above = 0.0;
  double below = 0.0;
  for (std::size_t n = 1; n + 1 < moved.size(); ++n) {
    above += (moved[n + 1] + moved[n - 1]) * moved[n];
    below += 2.0 * moved[n] * moved[n];
  }
  return 2.0 / dt * std::tan(0.5 * std::acos(above / below));
}

/// Of linear elements with consistent mass.
double discrete(int n, double length, double speed) {
  const double h = length / n;
  const double kh = 0.5 * std::numbers::pi / n;
  return speed / h * std::sqrt(6.0 * (1.0 - std::cos(kh)) / (2.0 + std::cos(kh)));
}

TEST(SolidWaves, AColumnHeldLaterallyHasTheFrequencyOfLinearElements) {
  // lambda 10: first frequency c_P/40 = 2.55758675317 /ms of the continuum, c_P = sqrt((lambda + 2 mu)/rho).
  const double speed = std::sqrt((10.0 + 2.0 * 0.233) / density);
  for (const Formulation formulation : {Formulation::displacement, Formulation::mean_dilatation}) {
    Material material = test::rubber(0.233, 10.0, formulation);
    for (const int n : {8, 16}) {
      const double omega = frequency(column(n, 10.0, material, formulation), 10.0, 0.01);
      EXPECT_NEAR(omega, discrete(n, 10.0, speed), 1e-5 * omega) << n;
      std::cout << "column of " << n << ": " << omega << " against " << discrete(n, 10.0, speed) << '\n';
    }
  }
}

TEST(SolidWaves, ABarWithoutLateralContractionHasThePublishedFrequencies) {
  // Bonet and Wood with lambda 0 has Young's modulus 2 mu and no contraction: a bar of speed sqrt(2 mu/rho). The
  // numbers are those of numerics 3.6 for the speed 26.4386081328.
  const double published[3] = {0.415964127696, 0.415463486607, 0.415338381953};
  const double mu = 0.5 * density * 26.4386081328 * 26.4386081328;
  const Material material = test::rubber(mu, 0.0, Formulation::displacement);
  for (int k = 0; k < 3; ++k) {
    const double omega = frequency(column(8 << k, 100.0, material, Formulation::displacement), 100.0, 0.1);
    EXPECT_NEAR(omega, published[k], 1e-5 * published[k]);
    std::cout << "bar of " << (8 << k) << ": " << omega << " against " << published[k] << '\n';
  }
}

}  // namespace
}  // namespace muldi::fem
