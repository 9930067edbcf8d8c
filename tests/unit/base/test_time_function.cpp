#include "base/time_function.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace muldi::base {
namespace {

TimeFunction function(TimeFunction::Kind kind) { return TimeFunction(std::move(kind)); }

TEST(TimeFunction, ConstantIsConstant) {
  const TimeFunction constant = 3.0;
  EXPECT_TRUE(constant.is_constant());
  EXPECT_EQ(constant.at(-1.0), 3.0);
  EXPECT_EQ(constant.at(1e9), 3.0);
  EXPECT_EQ(TimeFunction().at(1.0), 0.0);
}

TEST(TimeFunction, StepsHoldUntilTheNextTime) {
  const TimeFunction steps =
      function(Samples{.between = Samples::Between::held, .times = {0, 10, 20}, .values = {1, 2, 3}});
  EXPECT_FALSE(steps.is_constant());
  EXPECT_EQ(steps.at(0.0), 1.0);
  EXPECT_EQ(steps.at(9.999), 1.0);
  EXPECT_EQ(steps.at(10.0), 2.0);
  EXPECT_EQ(steps.at(25.0), 3.0);
  EXPECT_EQ(steps.at(-5.0), 1.0);
}

TEST(TimeFunction, TableIsLinearBetweenAndConstantOutside) {
  const TimeFunction table =
      function(Samples{.between = Samples::Between::linear, .times = {0, 10, 30}, .values = {1, 2, 0}});
  EXPECT_EQ(table.at(-1.0), 1.0);
  EXPECT_DOUBLE_EQ(table.at(2.5), 1.25);
  EXPECT_EQ(table.at(10.0), 2.0);
  EXPECT_DOUBLE_EQ(table.at(20.0), 1.0);
  EXPECT_EQ(table.at(31.0), 0.0);
}

TEST(TimeFunction, RampRunsFromStartOverItsTime) {
  const TimeFunction ramp = function(Ramp{.from = 1, .to = 3, .start = 10, .over = 20});
  EXPECT_EQ(ramp.at(0.0), 1.0);
  EXPECT_EQ(ramp.at(10.0), 1.0);
  EXPECT_EQ(ramp.at(20.0), 2.0);
  EXPECT_EQ(ramp.at(30.0), 3.0);
  EXPECT_EQ(ramp.at(99.0), 3.0);
}

TEST(TimeFunction, SineCountsCyclesAndPhaseInRadians) {
  const double pi = std::acos(-1.0);
  const TimeFunction sine = function(Sine{.amplitude = 2, .frequency = 0.25, .phase = pi / 6, .offset = 1});
  EXPECT_DOUBLE_EQ(sine.at(0.0), 2.0);                   // 1 + 2 sin(30 deg)
  EXPECT_DOUBLE_EQ(sine.at(1.0), 1.0 + std::sqrt(3.0));  // a quarter of a cycle on: 1 + 2 cos(30 deg)
  EXPECT_NEAR(sine.at(4.0), 2.0, 4e-15);                 // one period on; the argument is rounded at 6.8
}

TEST(TimeFunction, FormulaIsEvaluated) {
  std::string error;
  const TimeFunction formula = function(Expression::make("2*t+1", error));
  EXPECT_EQ(formula.at(3.0), 7.0);
  EXPECT_EQ(formula, function(Expression::make("2*t+1", error)));
}

TEST(TimeFunction, EqualWhereKindAndNumbersAre) {
  EXPECT_EQ(TimeFunction(1.0), TimeFunction(1.0));
  EXPECT_NE(TimeFunction(1.0), TimeFunction(2.0));
  EXPECT_NE(TimeFunction(0.0), function(Ramp{}));
}

TEST(WhyInvalid, AcceptsIncreasingTimes) {
  EXPECT_EQ(why_invalid({.times = {-1, 0, 2}, .values = {0, 0, 0}}), "");
  EXPECT_EQ(why_invalid({.times = {0}, .values = {5}}), "");
}

TEST(WhyInvalid, NamesTheFirstBadRow) {
  std::size_t row = 99;
  EXPECT_EQ(why_invalid({}, &row), "has no rows");
  EXPECT_EQ(why_invalid({.times = {0, 1}, .values = {1}}, &row), "needs as many values as times");
  EXPECT_EQ(why_invalid({.times = {0, 2, 2}, .values = {1, 1, 1}}, &row), "needs increasing times, got 2 after 2");
  EXPECT_EQ(row, 2u);
  EXPECT_EQ(why_invalid({.times = {0, 2, 1.5}, .values = {1, 1, 1}}, &row), "needs increasing times, got 1.5 after 2");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(why_invalid({.times = {0, 1}, .values = {1, nan}}, &row), "needs finite numbers");
  EXPECT_EQ(row, 1u);
}

}  // namespace
}  // namespace muldi::base
