/// How fast controls change at a node, from either side of kinks and jumps.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "variational/control_rates.hpp"

namespace muldi::variational {
namespace {

model::Model with(base::TimeFunction::Kind kind) {
  model::Model model;
  model.controls.push_back({"c", {}, base::TimeFunction(std::move(kind))});
  return model;
}

TEST(ControlRates, AreTheDerivativeOfASmoothFunction) {
  const model::Model model = with(base::Sine{.amplitude = 2.0, .frequency = 0.05, .phase = 0.3, .offset = 7.0});
  ControlRates rates(model, 0.1);
  const double omega = 2.0 * std::numbers::pi * 0.05;
  for (const double t : {0.0, 3.7, 80.0}) {
    for (const Side side : {Side::before, Side::after, Side::both}) {
      EXPECT_NEAR(rates.at(t, side)[0], 2.0 * omega * std::cos(omega * t + 0.3), 2e-9) << t;
    }
  }
}

TEST(ControlRates, TakeTheSideOfAKinkOrTheMean) {
  const model::Model model = with(base::Ramp{.from = 0.0, .to = 3.0, .start = 0.3, .over = 1.5});
  ControlRates rates(model, 0.1);
  const double t = 3 * 0.1;  // not 0.3 to the last bit
  EXPECT_NEAR(rates.at(t, Side::before)[0], 0.0, 1e-11);
  EXPECT_NEAR(rates.at(t, Side::after)[0], 2.0, 1e-9);
  EXPECT_NEAR(rates.at(t, Side::both)[0], 1.0, 1e-9);
}

TEST(ControlRates, HaveNothingOfAJump) {
  const model::Model model =
      with(base::Samples{.between = base::Samples::Between::held, .times = {0.0, 0.3}, .values = {1.0, 5.0}});
  ControlRates rates(model, 0.1);
  for (const double t : {0.3, 3 * 0.1}) {
    for (const Side side : {Side::before, Side::after, Side::both}) EXPECT_EQ(rates.at(t, side)[0], 0.0);
  }
}

}  // namespace
}  // namespace muldi::variational
