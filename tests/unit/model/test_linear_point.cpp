/// Linear points and their products: values, rates, transposes, and Hessians against differences.
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "math/derivative_check.hpp"
#include "model/bilinear.hpp"

namespace muldi::model {
namespace {

/// 1 + 2 q[0..3) - q[3..6).
LinearPoint example() {
  LinearPoint point = LinearPoint::constant(Eigen::Vector3d(1.0, 1.0, 1.0));
  point.add(0, 0, 2.0);
  point.add(1, 3, -1.0);
  return point;
}

const Eigen::VectorXd q{{1.0, 2.0, 3.0, 4.0, 5.0, 6.0}};
const Eigen::VectorXd v{{0.5, -0.2, 0.1, 0.3, 0.7, -0.4}};

TEST(LinearPoint, AddsOffsetAndWeightedTriples) {
  EXPECT_EQ(example().value(q), Eigen::Vector3d(-1.0, 0.0, 1.0));
  EXPECT_EQ(example().rate(q), Eigen::Vector3d(-2.0, -1.0, 0.0));
  EXPECT_FALSE(example().is_constant());
  EXPECT_TRUE(LinearPoint::constant(Eigen::Vector3d::Zero()).is_constant());
}

TEST(LinearPoint, LeavesOutZeroWeights) {
  LinearPoint point;
  point.add(0, 0, 0.0);
  EXPECT_TRUE(point.is_constant());
}

TEST(LinearPoint, HasTheTransposeOfItsRate) {
  const Eigen::Vector3d force(1.0, -2.0, 0.5);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(6);
  example().add_transposed(force, f);
  EXPECT_NEAR(f.dot(v), force.dot(example().rate(v)), 1e-15);
}

TEST(LinearPoint, DifferenceIsThatOfTheValues) {
  LinearPoint other;
  other.add(1, 3, 0.5);
  const LinearPoint difference = example() - other;
  EXPECT_EQ(difference.value(q), Eigen::Vector3d(example().value(q) - other.value(q)));
  EXPECT_EQ(difference.n, 3);
}

TEST(LinearPoint, RefusesMoreEntriesThanItHolds) {
  LinearPoint point;
  for (int k = 0; k < LinearPoint::capacity; ++k) point.add(k, 3 * k, 1.0);
  EXPECT_THROW(point.add(0, 0, 1.0), base::ContractError);
}

TEST(Bilinear, GradientAndHessianAreThoseOfItsValue) {
  LinearPoint b;
  b.add(0, 0, -0.3);
  b.add(1, 3, 0.8);
  const Bilinear form{.a = example(), .b = b, .constant = 0.7, .scale = 1.5};
  const auto value = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return Eigen::VectorXd::Constant(1, form.value(x));
  };
  const auto gradient = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    Eigen::VectorXd g = Eigen::VectorXd::Zero(6);
    form.add_gradient(x, 2.0, g);
    return g;
  };
  const Eigen::VectorXd h = Eigen::VectorXd::Constant(6, 0.1);
  // Differences of polynomials of second order are exact.
  EXPECT_LT(math::derivative_error(gradient(q).transpose(), 2.0 * math::difference_jacobian(value, q, h)).relative,
            1e-12);
  EXPECT_NEAR(form.rate(q, v), 0.5 * gradient(q).dot(v), 1e-14);
  Eigen::VectorXd column = Eigen::VectorXd::Zero(6);
  form.add_hessian_times(v, 2.0, column);
  EXPECT_LT((column - math::difference_jacobian(gradient, q, h) * v).norm(), 1e-12);
}

}  // namespace
}  // namespace muldi::model
