/// 1e6 steps of conservative pendulums and of the muscle joint (numerics 5 no. 4, 6).
#include <gtest/gtest.h>

#include <iostream>

#include "stress/energy_history.hpp"
#include "support/figure.hpp"
#include "support/redundant_update.hpp"
#include "support/systems.hpp"

namespace muldi {
namespace {

void expect_steady(const std::string& name, const model::Model& model, const variational::State& start, double dt) {
  const test::EnergyHistory history = test::energy_history(model, start, dt, 1'000'000);
  std::cout << "band " << history.band().all / history.swing() << " of " << history.swing() << " mJ, last/first tenth "
            << history.band().last_tenth / history.band().first_tenth << ", drift of the mean "
            << history.drift() / history.swing() << ", violation " << history.violation() << '\n';
  test::record_figure("4", name + ", 1e6 steps, energy band of the last tenth over that of the first",
                      history.band().last_tenth / history.band().first_tenth, 1.1);
  test::record_figure("4", name + ", 1e6 steps, drift of the mean energy over its swing",
                      std::abs(history.drift()) / history.swing(), 1e-9);
  test::record_figure("6", name + ", 1e6 steps, violation of constraints", history.violation(), 1e-11);
  test::record_figure("6", name + ", 1e6 steps, violation of the last tenth over that of the first",
                      history.violation_growth(), test::root_of_ten);
}

TEST(MillionSteps, OfThePendulum) {
  const auto model = test::make_model(test::pendulum());
  expect_steady("pendulum", *model, test::state_at_rest(*model), 10.0);
}

TEST(MillionSteps, OfTheMuscleJoint) {
  const auto model = test::make_model(test::undamped(test::muscle_joint(3e4)));
  expect_steady("muscle joint", *model, test::state_at_rest(*model), 5.0);
}

TEST(MillionSteps, OfTheDoublePendulumInRegularMotion) {
  // Released at 20 degrees from the bottom, stretched: no chaos.
  const auto model = test::make_model(test::double_pendulum());
  const Eigen::Vector2d released(-70.0 * test::degree, 0.0);
  expect_steady("double pendulum", *model, test::state_at(*model, released, Eigen::Vector2d::Zero()), 10.0);
}

TEST(MillionSteps, WithRedundantUnknownsKeepTheirConstraints) {
  const auto model = test::make_model(test::pendulum());
  const test::RedundantUpdate redundant(*model, 10.0);
  variational::State state = test::state_at_rest(*model);
  const long steps = 1'000'000;
  test::Band gaps;
  for (long n = 0; n < steps; ++n) {
    ASSERT_GT(redundant.advance(state.q, state.p, {}), 0) << n;
    gaps.add(model->manifold->violation(state.q), n, steps);
  }
  test::record_figure("6", "pendulum, 1e6 steps with redundant unknowns, violation of constraints", gaps.all, 1e-10);
  test::record_figure("6",
                      "pendulum, 1e6 steps with redundant unknowns, violation of the last tenth over that of the first",
                      gaps.last_tenth / gaps.first_tenth, test::root_of_ten);
}

}  // namespace
}  // namespace muldi
