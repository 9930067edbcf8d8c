/// 1e6 steps of a conservative pendulum and of the muscle joint (numerics 5 no. 4, 6).
#include <gtest/gtest.h>

#include <iostream>

#include "stress/energy_history.hpp"
#include "support/systems.hpp"

namespace muldi {
namespace {

void expect_steady(const test::RigidSystem& system, double dt) {
  const auto model = test::make_model(system);
  const test::EnergyHistory history = test::energy_history(*model, test::state_at_rest(*model), dt, 1'000'000);
  std::cout << "band " << history.band().all / history.swing() << " of " << history.swing() << " mJ, last/first tenth "
            << history.band().last_tenth / history.band().first_tenth << ", drift of the mean "
            << history.drift() / history.swing() << ", violation " << history.violation() << '\n';
  EXPECT_LE(history.band().last_tenth, 1.1 * history.band().first_tenth);
  EXPECT_LT(std::abs(history.drift()), 1e-9 * history.swing());
  EXPECT_LT(history.violation(), 1e-11);
}

TEST(MillionSteps, OfThePendulum) { expect_steady(test::pendulum(), 10.0); }

TEST(MillionSteps, OfTheMuscleJoint) { expect_steady(test::undamped(test::muscle_joint(3e4)), 5.0); }

}  // namespace
}  // namespace muldi
