/// What `check --derivatives` calls right and wrong.
#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/checked_line.hpp"

namespace muldi::pipeline {
namespace {

Eigen::VectorXd sine(double s) { return Eigen::VectorXd::Constant(1, std::sin(0.3 + 0.1 * s)); }

Eigen::VectorXd one(double value) { return Eigen::VectorXd::Constant(1, value); }

TEST(CheckedLine, PassesTheDerivative) {
  const CheckedDerivative line = checked_line("sine", sine, one(0.1 * std::cos(0.3)));
  EXPECT_TRUE(line.passed);
  EXPECT_LT(line.error, 1e-10);
  EXPECT_NEAR(line.slope, 2.0, 0.05);  // the remainder of a correct first derivative
}

TEST(CheckedLine, FindsAnErrorOfOneInAHundredThousand) {
  const CheckedDerivative line = checked_line("sine", sine, one(0.1 * std::cos(0.3) * (1.0 + 1e-5)));
  EXPECT_FALSE(line.passed);
  EXPECT_NEAR(line.error, 1e-5, 1e-9);
}

TEST(CheckedLine, FindsADerivativeThatIsMissing) { EXPECT_FALSE(checked_line("sine", sine, one(0.0)).passed); }

TEST(CheckedLine, PassesNothingOfNothing) {
  EXPECT_TRUE(checked_line(
                  "constant", [](double) { return one(1e3); }, one(0.0))
                  .passed);
}

}  // namespace
}  // namespace muldi::pipeline
