/// The double pendulum at large angles is chaotic: energies can be compared, points cannot (numerics 5 no. 33).
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "multibody/registry.hpp"
#include "stress/energy_history.hpp"
#include "support/figure.hpp"
#include "support/systems.hpp"
#include "variational/stepper.hpp"

namespace muldi {
namespace {

TEST(Chaos, KeepsTheEnergyInABandThatScalesWithTheStep) {
  const auto model = test::make_model(test::double_pendulum());
  const variational::State start = test::state_at_rest(*model);
  const test::EnergyHistory coarse = test::energy_history(*model, start, 5.0, 100'000);
  const test::EnergyHistory fine = test::energy_history(*model, start, 2.5, 200'000);
  std::cout << "band " << coarse.band().all / coarse.swing() << " of " << coarse.swing() << " mJ, last/first tenth "
            << coarse.band().last_tenth / coarse.band().first_tenth << ", ratio " << coarse.band().all / fine.band().all
            << ", violation " << coarse.violation() << '\n';
  // The largest error is that of the fastest moment met, which differs from run to run.
  test::record_figure("33", "chaotic pendulum, energy band of the last tenth over that of the first",
                      coarse.band().last_tenth / coarse.band().first_tenth, 2.0);
  test::record_near("33", "chaotic pendulum, energy band over that of half the step",
                    coarse.band().all / fine.band().all, 4.0, 1.0);
  EXPECT_LT(coarse.violation(), 1e-11);
}

TEST(Chaos, ForgetsItsStartButNotItsEnergy) {
  const auto model = test::make_model(test::double_pendulum());
  const auto end = [&](double offset, long steps) {
    const variational::State start = test::state_at(*model, Eigen::Vector2d(0.0, offset), Eigen::Vector2d::Zero());
    double energy = 0.0;
    const test::Run done = test::run(*model, start, {.dt = 5.0, .steps = steps}, [&](const auto& node) {
      energy = node.values.total.kinetic + node.values.total.potential();
    });
    return std::pair(done.state.q, energy);
  };
  const double short_time = (end(1e-10, 100).first - end(0.0, 100).first).norm();
  const auto [q, energy] = end(0.0, 8000);
  const auto [q_other, energy_other] = end(1e-10, 8000);
  std::cout << "apart " << short_time << " mm, then " << (q_other - q).norm() << " mm; energies " << energy << ' '
            << energy_other << '\n';
  EXPECT_LT(short_time, 1e-6);
  test::record_at_least("33", "chaotic pendulum, distance of two paths 1e-10 rad apart after 40 s (mm)",
                        (q_other - q).norm(), 1.0);
  // Swing of the potential: 2 m g l (1 + 3) with l = 46 mm, about 144 mJ.
  test::record_figure("33", "chaotic pendulum, difference of their energies over the swing",
                      std::abs(energy - energy_other) / 144.0, 0.01);
}

TEST(Chaos, KeepsTheAngularMomentumAboutTheVertical) {
  // Two bodies on ball joints under gravity, thrown to the side; the first joint is at the origin.
  test::RigidSystem system;
  system.gravity = Eigen::Vector3d(0.0, 0.0, -test::earth_gravity);
  system.add_body(40.0, {2e4, 3e4, 3e4}, {.position = {46.0, 0.0, 0.0}});
  system.add_body(40.0, {2e4, 3e4, 3e4}, {.position = {138.0, 0.0, 0.0}});
  system.connect(multibody::Spherical::pattern, {multibody::ground, 0}, Eigen::Vector3d::Zero());
  system.connect(multibody::Spherical::pattern, {0, 1}, {92.0, 0.0, 0.0});
  const auto model = test::make_model(system);
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(6);
  rates[2] = 0.004;
  double first = 0.0;
  double largest = 0.0;
  const test::Run done = test::run(*model, test::state_at(*model, model->manifold->reference(), rates),
                                   {.dt = 2.0, .steps = 20'000}, [&](const variational::NodeRecord& node) {
                                     const double about_z = node.values.angular_momentum.z();
                                     if (node.step == 0) first = about_z;
                                     largest = std::max(largest, std::abs(about_z - first));
                                   });
  ASSERT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
  ASSERT_GT(std::abs(first), 1.0);
  test::record_figure("33", "chaotic spherical pendulum, 2e4 steps, angular momentum about the vertical, relative",
                      largest / std::abs(first), 1e-10);
}

struct Divergence {
  double rate = 0.0;            ///< mean over the pairs, 1/ms
  double standard_error = 0.0;  ///< of the mean
};

/// How fast paths that start 1e-9 rad apart part up to 1e-4 rad: the inverse of Lyapunov's time, from many starts.
Divergence divergence(const model::Model& model, double dt) {
  constexpr double near = 1e-9;
  constexpr double far = 1e-4;
  constexpr int pairs = 24;
  double sum = 0.0;
  double squares = 0.0;
  for (int k = 0; k < pairs; ++k) {
    variational::Stepper stepper(model, dt, {});
    const auto released = [&](double offset) {
      return test::state_at(model, Eigen::Vector2d(0.02 * k, offset), Eigen::Vector2d::Zero());
    };
    variational::State one = released(0.0);
    variational::State other = released(near);
    while ((one.x - other.x).norm() < far && one.t < 40'000.0) {
      EXPECT_EQ(stepper.advance(one, {}).status, variational::Status::running);
      EXPECT_EQ(stepper.advance(other, {}).status, variational::Status::running);
    }
    const double rate = std::log((one.x - other.x).norm() / near) / one.t;
    sum += rate;
    squares += rate * rate;
  }
  const double mean = sum / pairs;
  return {.rate = mean, .standard_error = std::sqrt((squares / pairs - mean * mean) / (pairs - 1))};
}

TEST(Chaos, LyapunovsTimeDoesNotDependOnTheStep) {
  const auto model = test::make_model(test::double_pendulum());
  const Divergence coarse = divergence(*model, 5.0);
  const Divergence fine = divergence(*model, 2.5);
  std::cout << "rates " << coarse.rate << " +- " << coarse.standard_error << ", " << fine.rate << " +- "
            << fine.standard_error << " 1/ms\n";
  const double scatter = std::hypot(coarse.standard_error, fine.standard_error);
  EXPECT_LT(scatter, 0.1 * fine.rate) << "enough starts to tell";
  test::record_figure("33",
                      "chaotic pendulum, Lyapunov's rates of a step and of half of it, difference over its scatter",
                      std::abs(coarse.rate - fine.rate) / scatter, 3.0);
}

}  // namespace
}  // namespace muldi
