/// Ten thousand steps and back, and the drift of redundant unknowns (numerics 5 no. 6, 15).
#include <gtest/gtest.h>

#include "support/figure.hpp"
#include "support/redundant_update.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi::variational {
namespace {

using Eigen::VectorXd;

TEST(LongRun, OfAPendulumReturnsFromTenThousandSteps) {
  const auto model = test::make_model(test::pendulum());
  Stepper stepper(*model, 5.0, {.tolerance = 1e-13});
  State state = test::state_at_rest(*model);
  const VectorXd begin = state.q;
  for (int n = 0; n < 20000; ++n) {
    if (n == 10000) {
      state.p = -state.p;
      state.increment.setZero();
    }
    ASSERT_EQ(stepper.advance(state, {}).status, Status::running);
  }
  test::record_figure("15", "pendulum, 10000 steps there and back, positions (mm)",
                      (state.q - begin).lpNorm<Eigen::Infinity>(), 1e-9);
}

TEST(LongRun, WithRedundantUnknownsKeepsItsConstraintsAsWell) {
  // The referee: below 1e-10 (numerics 5 no. 6).
  const auto model = test::make_model(test::pendulum());
  const test::RedundantUpdate redundant(*model, 5.0);
  State state = test::state_at_rest(*model);
  double largest = 0.0;
  for (int n = 0; n < 20000; ++n) {
    ASSERT_GT(redundant.advance(state.q, state.p, {}), 0);
    largest = std::max(largest, model->manifold->violation(state.q));
  }
  test::record_figure("6", "pendulum, 2e4 steps with redundant unknowns, violation of constraints", largest, 1e-10);
}

}  // namespace
}  // namespace muldi::variational
