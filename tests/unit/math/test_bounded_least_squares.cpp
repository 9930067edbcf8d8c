/// Bounded least squares on problems with known minima.
#include "math/bounded_least_squares.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace muldi::math {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Rosenbrock's valley: residuals 10 (y - x^2) and 1 - x, zero at (1, 1).
bool rosenbrock(const VectorXd& x, VectorXd& r, MatrixXd* J) {
  r = Vector2d(10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]);
  if (J != nullptr) *J = (MatrixXd(2, 2) << -20.0 * x[0], 10.0, -1.0, 0.0).finished();
  return true;
}

TEST(BoundedLeastSquares, FindsTheMinimumOfAValley) {
  const LeastSquaresProblem problem{.lower = Vector2d(-2, -2), .upper = Vector2d(2, 2), .evaluate = rosenbrock};
  const LeastSquaresResult found = minimise(problem, Vector2d(-1.2, 1.0), {});
  EXPECT_EQ(found.end, LeastSquaresEnd::converged);
  EXPECT_NEAR(found.x[0], 1.0, 1e-12);
  EXPECT_NEAR(found.x[1], 1.0, 1e-12);
}

TEST(BoundedLeastSquares, StopsAtABound) {
  // With x <= 1/2 the minimum lies at x = 1/2, y = 1/4: both residuals there by hand.
  const LeastSquaresProblem problem{.lower = Vector2d(-2, -2), .upper = Vector2d(0.5, 2), .evaluate = rosenbrock};
  const LeastSquaresResult found = minimise(problem, Vector2d(-1.2, 1.0), {});
  EXPECT_EQ(found.end, LeastSquaresEnd::converged);
  EXPECT_DOUBLE_EQ(found.x[0], 0.5);
  EXPECT_NEAR(found.x[1], 0.25, 1e-12);
  EXPECT_NEAR(found.cost, 0.125, 1e-12);
}

TEST(BoundedLeastSquares, LeavesDirectionsWithoutEffectAlone) {
  const auto sum = [](const VectorXd& x, VectorXd& r, MatrixXd* J) {
    r = VectorXd::Constant(1, x[0] + x[1] - 1.0);
    if (J != nullptr) *J = MatrixXd::Ones(1, 2);
    return true;
  };
  const LeastSquaresProblem problem{.lower = Vector2d(-2, -2), .upper = Vector2d(2, 2), .evaluate = sum};
  const LeastSquaresResult found = minimise(problem, Vector2d(1.0, 0.5), {});
  EXPECT_NEAR(found.x[0], 0.75, 1e-13);  // the nearest of all solutions
  EXPECT_NEAR(found.x[1], 0.25, 1e-13);
}

TEST(BoundedLeastSquares, StepsBackWhereItCannotBeEvaluated) {
  // log x needs x > 0, where the full first step from 3 does not lead.
  const auto logarithm = [](const VectorXd& x, VectorXd& r, MatrixXd* J) {
    if (x[0] <= 0.0) return false;
    r = VectorXd::Constant(1, std::log(x[0]));
    if (J != nullptr) *J = MatrixXd::Constant(1, 1, 1.0 / x[0]);
    return true;
  };
  const LeastSquaresProblem problem{
      .lower = VectorXd::Constant(1, -5.0), .upper = VectorXd::Constant(1, 5.0), .evaluate = logarithm};
  const LeastSquaresResult found = minimise(problem, VectorXd::Constant(1, 3.0), {});
  EXPECT_NEAR(found.x[0], 1.0, 1e-10);
  const LeastSquaresResult none = minimise(problem, VectorXd::Constant(1, -1.0), {});
  EXPECT_EQ(none.end, LeastSquaresEnd::cannot_evaluate);
}

}  // namespace
}  // namespace muldi::math
