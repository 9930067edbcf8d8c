/// dH = work of the sources + external work - dissipation, to second order (numerics 5 no. 24).
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi::variational {
namespace {

using base::Samples;
using base::Sine;
using base::TimeFunction;

/// What the ledger leaves over at the end of a run, divided by the energy that went through it.
struct Balance {
  double left_over = 0.0;
  double turnover = 0.0;
};

Balance balance(const model::Model& model, double dt, long steps) {
  Balance result;
  const test::Run done =
      test::run(model, test::state_at_rest(model), {.dt = dt, .steps = steps}, [&](const NodeRecord& node) {
        const Ledger& ledger = node.ledger;
        const double total = node.values.total.kinetic + node.values.total.potential();
        result.left_over = total - ledger.initial_total + ledger.dissipated - ledger.external - ledger.source;
        result.turnover = ledger.dissipated + std::abs(ledger.external) + std::abs(ledger.source);
      });
  EXPECT_EQ(done.result.status, Status::completed);
  return result;
}

void expect_closing(const test::RigidSystem& system, double dt, long steps) {
  const auto model = test::make_model(system);
  const Balance coarse = balance(*model, dt, steps);
  const Balance fine = balance(*model, 0.5 * dt, 2 * steps);
  std::cout << "left over " << coarse.left_over / coarse.turnover << " of " << coarse.turnover << " mJ, ratio "
            << coarse.left_over / fine.left_over << '\n';
  EXPECT_GT(coarse.turnover, 0.0);
  EXPECT_LT(std::abs(coarse.left_over), 1e-2 * coarse.turnover);
  EXPECT_NEAR(coarse.left_over / fine.left_over, 4.0, 0.2);
}

TEST(PowerBalance, ClosesForTheDampedJoint) { expect_closing(test::muscle_joint(3e4), 1.0, 100); }

TEST(PowerBalance, ClosesForTheDampedMembrane) { expect_closing(test::membrane(3e4, 0.01), 0.01, 50); }

TEST(PowerBalance, ClosesOverJumpsOfTheVoltage) {
  test::RigidSystem joint = test::muscle_joint(0.0);
  joint.controls[0].function = TimeFunction(Samples{.times = {0.0, 20.0, 50.0}, .values = {1e4, 3e4, 2e4}});
  joint.controls[1].function = TimeFunction(Samples{.times = {0.0, 30.0}, .values = {0.0, 2e4}});
  expect_closing(joint, 1.0, 75);
  test::RigidSystem film = test::membrane(0.0, 0.01);
  film.controls[0].function = TimeFunction(Samples{.times = {0.0, 0.1, 0.3}, .values = {1e4, 3e4, 2e4}});
  expect_closing(film, 0.01, 50);
}

TEST(PowerBalance, ClosesUnderASmoothVoltage) {
  test::RigidSystem joint = test::muscle_joint(0.0);
  joint.controls[0].function = TimeFunction(Sine{.amplitude = 1.5e4, .frequency = 0.02, .phase = 0.3, .offset = 2e4});
  expect_closing(joint, 1.0, 100);
  test::RigidSystem film = test::membrane(0.0, 0.01);
  film.controls[0].function = TimeFunction(Sine{.amplitude = 1e4, .frequency = 1.0, .phase = 0.3, .offset = 2e4});
  expect_closing(film, 0.01, 50);
}

TEST(PowerBalance, ClosesForADrivenAndDampedPendulum) {
  test::RigidSystem system = test::pendulum();
  system.controls = {{.name = "drive", .unit = base::dimension::torque, .function = 8.0}};
  system.joint_forces.push_back({.joint = 0, .stiffness = 10.0, .damping = 300.0, .control = 0, .constant = 2.0});
  expect_closing(system, 8.0, 60);
}

}  // namespace
}  // namespace muldi::variational
