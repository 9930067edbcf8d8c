/// The referees of derivatives on functions whose derivatives are known.
#include "math/derivative_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace muldi::math {
namespace {

/// (exp(x) y, sin(x y)).
template <class Vector>
Vector sample(const Vector& x) {
  using std::exp;
  using std::sin;
  return Vector{{exp(x[0]) * x[1], sin(x[0] * x[1])}};
}

const Eigen::VectorXd at{{0.3, 0.8}};

Eigen::MatrixXd jacobian(const Eigen::VectorXd& x) {
  const double c = std::cos(x[0] * x[1]);
  return Eigen::MatrixXd{{std::exp(x[0]) * x[1], std::exp(x[0])}, {x[1] * c, x[0] * c}};
}

TEST(DerivativeCheck, ExtrapolatedDifferencesReachElevenDigits) {
  const auto J = difference_jacobian(sample<Eigen::VectorXd>, at, Eigen::VectorXd::Constant(2, 0.02));
  EXPECT_LE(derivative_error(jacobian(at), J).relative, 1e-11);
}

TEST(DerivativeCheck, ComplexStepIsExactToRoundOff) {
  const auto J = complex_step_jacobian(sample<Eigen::VectorXcd>, at);
  EXPECT_LE(derivative_error(jacobian(at), J).relative, 1e-15);
}

TEST(DerivativeCheck, NamesTheWorstEntry) {
  Eigen::MatrixXd wrong = jacobian(at);
  wrong(1, 0) += 0.01;
  const DerivativeError error = derivative_error(wrong, jacobian(at));
  EXPECT_EQ(error.row, 1);
  EXPECT_EQ(error.column, 0);
  EXPECT_DOUBLE_EQ(error.given - error.expected, wrong(1, 0) - jacobian(at)(1, 0));
  EXPECT_NEAR(error.relative, 0.01 / jacobian(at).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(DerivativeCheck, DoesNotLetNanPass) {
  Eigen::MatrixXd wrong = jacobian(at);
  wrong(0, 1) = std::numeric_limits<double>::quiet_NaN();
  const DerivativeError error = derivative_error(wrong, jacobian(at));
  EXPECT_TRUE(std::isnan(error.relative));
  EXPECT_EQ(error.row, 0);
  EXPECT_EQ(error.column, 1);
}

TEST(DerivativeCheck, RefusesDifferentShapes) {
  EXPECT_THROW(derivative_error(Eigen::MatrixXd::Zero(2, 2), Eigen::MatrixXd::Zero(2, 3)), base::ContractError);
}

TEST(TaylorTest, SlopeIsOneMoreThanTheNumberOfRightDerivatives) {
  const TaylorSetup setup{.x = at, .direction = Eigen::VectorXd{{0.6, -0.7}}};
  const Eigen::VectorXd first = jacobian(at) * setup.direction;
  // d2/ds2 along (a, b): (exp(x)(a^2 y + 2 a b), 2 a b cos(xy) - (b x + a y)^2 sin(xy)).
  const double a = 0.6;
  const double b = -0.7;
  const double xy = 0.24;
  const double turn = b * 0.3 + a * 0.8;
  const Eigen::VectorXd second{
      {std::exp(0.3) * (a * a * 0.8 + 2.0 * a * b), 2.0 * a * b * std::cos(xy) - turn * turn * std::sin(xy)}};
  EXPECT_NEAR(taylor_test(sample<Eigen::VectorXd>, {}, setup).slope, 1.0, 0.02);
  EXPECT_NEAR(taylor_test(sample<Eigen::VectorXd>, {first}, setup).slope, 2.0, 0.02);
  EXPECT_NEAR(taylor_test(sample<Eigen::VectorXd>, {first, second}, setup).slope, 3.0, 0.05);
  EXPECT_NEAR(taylor_test(sample<Eigen::VectorXd>, {1.001 * first}, setup).slope, 1.0, 0.3);
}

TEST(TaylorTest, OfAnExactExpansionIsInfinite) {
  const TaylorSetup setup{.x = at, .direction = Eigen::VectorXd{{1.0, 2.0}}};
  const auto linear = [](const Eigen::VectorXd& x) { return Eigen::VectorXd::Constant(1, 3.0 * x[0] - x[1]).eval(); };
  const TaylorTest test = taylor_test(linear, {Eigen::VectorXd::Constant(1, 1.0)}, setup);
  EXPECT_EQ(test.slope, std::numeric_limits<double>::infinity());
  EXPECT_EQ(test.remainder.size(), 8u);
}

}  // namespace
}  // namespace muldi::math
