/// Energy bands and drift of the constraints over 1e5 steps (numerics 5 no. 4, 6).
#include <gtest/gtest.h>

#include <iostream>

#include "stress/energy_history.hpp"
#include "support/figure.hpp"
#include "support/systems.hpp"

namespace muldi {
namespace {

constexpr long steps = 100'000;

/// The band does not grow and scales with dt^2; constraints do not drift.
void expect_steady(const std::string& name, const test::RigidSystem& system, const variational::State& start,
                   double dt) {
  const auto model = test::make_model(system);
  const test::EnergyHistory coarse = test::energy_history(*model, start, dt, steps);
  const test::EnergyHistory fine = test::energy_history(*model, start, 0.5 * dt, steps);
  std::cout << "band " << coarse.band().all / coarse.swing() << " of " << coarse.swing() << " mJ, last/first tenth "
            << coarse.band().last_tenth / coarse.band().first_tenth << ", ratio " << coarse.band().all / fine.band().all
            << ", violation " << coarse.violation() << '\n';
  test::record_figure("4", name + ", 1e5 steps, energy band of the last tenth over that of the first",
                      coarse.band().last_tenth / coarse.band().first_tenth, 1.1);
  test::record_near("4", name + ", energy band over that of half the step", coarse.band().all / fine.band().all, 4.0,
                    0.2);
  test::record_figure("6", name + ", 1e5 steps, violation of constraints", coarse.violation(), 1e-11);
  test::record_figure("6", name + ", 1e5 steps, violation of the last tenth over that of the first",
                      coarse.violation_growth(), test::root_of_ten);
}

TEST(Energy, OfThePendulumStaysInItsBand) {
  const test::RigidSystem system = test::pendulum();
  expect_steady("pendulum", system, test::state_at_rest(*test::make_model(system)), 10.0);
}

TEST(Energy, OfTheMuscleJointStaysInItsBand) {
  const test::RigidSystem system = test::undamped(test::muscle_joint(3e4));
  expect_steady("muscle joint", system, test::state_at_rest(*test::make_model(system)), 5.0);
}

TEST(Energy, OfTheDoublePendulumInRegularMotionStaysInItsBand) {
  // Released at 20 degrees from the bottom, stretched: two incommensurate modes, no chaos.
  const test::RigidSystem system = test::double_pendulum();
  const auto model = test::make_model(system);
  const Eigen::Vector2d released(-70.0 * test::degree, 0.0);
  expect_steady("double pendulum", system, test::state_at(*model, released, Eigen::Vector2d::Zero()), 10.0);
}

}  // namespace
}  // namespace muldi
