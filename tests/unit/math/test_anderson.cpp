#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>

#include "math/anderson.hpp"

namespace muldi::math {
namespace {

/// Iterations of x += P (b - A x) until the update is small.
int iterations(const Eigen::MatrixXd& a, const Eigen::MatrixXd& p, AndersonAcceleration* acceleration) {
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(a.rows(), -1.0, 2.0);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(a.rows());
  for (int i = 1; i < 1000; ++i) {
    Eigen::VectorXd f = p * (b - a * x);
    if (f.norm() < 1e-10) return i;
    if (acceleration != nullptr) acceleration->accelerate(x, f);
    x += f;
  }
  return 1000;
}

Eigen::MatrixXd definite_matrix(int n) {
  std::srand(5);
  const Eigen::MatrixXd r = Eigen::MatrixXd::Random(n, n);
  return r * r.transpose() / n + Eigen::MatrixXd::Identity(n, n);
}

TEST(AndersonAcceleration, SolvesALinearProblemInAsManyStepsAsUnknowns) {
  // With full depth it is GMRES (Walker and Ni): six unknowns, six steps and the ones that find out.
  const Eigen::MatrixXd a = definite_matrix(6);
  AndersonAcceleration acceleration(6);
  EXPECT_LE(iterations(a, 0.4 * Eigen::MatrixXd::Identity(6, 6), &acceleration), 8);
}

TEST(AndersonAcceleration, HalvesTheStepsOfASlowIteration) {
  const Eigen::MatrixXd a = definite_matrix(60);
  const Eigen::MatrixXd p = a.diagonal().cwiseInverse().asDiagonal() * Eigen::MatrixXd::Identity(60, 60) * 0.4;
  const int plain = iterations(a, p, nullptr);
  AndersonAcceleration acceleration(5);
  EXPECT_LT(iterations(a, p, &acceleration), plain / 2);
  EXPECT_EQ(acceleration.n_kept(), 5);
}

TEST(AndersonAcceleration, DoesNotDependOnUnitsWithWeights) {
  const Eigen::MatrixXd a = definite_matrix(20);
  const Eigen::MatrixXd p = 0.3 * Eigen::MatrixXd::Identity(20, 20);
  const Eigen::VectorXd unit = Eigen::VectorXd::LinSpaced(20, 1.0, 20.0);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(20);
  AndersonAcceleration plain(4);
  AndersonAcceleration weighted(4, unit.cwiseInverse());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(20);
  Eigen::VectorXd y = x;  // unit * x
  for (int i = 0; i < 8; ++i) {
    Eigen::VectorXd f = p * (b - a * x);
    Eigen::VectorXd g = unit.cwiseProduct(p * (b - a * y.cwiseQuotient(unit)));
    plain.accelerate(x, f);
    weighted.accelerate(y, g);
    x += f;
    y += g;
  }
  EXPECT_LT((y.cwiseQuotient(unit) - x).norm(), 1e-10 * x.norm());
}

TEST(AndersonAcceleration, LeavesOutRepeatedDifferences) {
  AndersonAcceleration acceleration(3);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(2);
  for (int i = 0; i < 6; ++i) {  // the same update again and again: all differences are zero
    Eigen::VectorXd f = Eigen::VectorXd::Ones(2);
    acceleration.accelerate(x, f);
    EXPECT_EQ(f, Eigen::VectorXd::Ones(2));
    x += f;
  }
}

TEST(AndersonAcceleration, ForgetsWhenTheUpdateGrows) {
  AndersonAcceleration acceleration(3);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(2);
  for (const double size : {1.0, 0.5, 0.2}) {
    Eigen::VectorXd f(2);
    f << size, -size * size;
    acceleration.accelerate(x, f);
    x += f;
  }
  EXPECT_EQ(acceleration.n_kept(), 2);
  Eigen::VectorXd f(2);
  f << 3.0, 1.0;
  acceleration.accelerate(x, f);
  EXPECT_EQ(f, (Eigen::Vector2d(3.0, 1.0)));
  EXPECT_EQ(acceleration.n_kept(), 0);
  f(0) = std::numeric_limits<double>::quiet_NaN();
  acceleration.accelerate(x, f);
  EXPECT_EQ(acceleration.n_kept(), 0);
}

}  // namespace
}  // namespace muldi::math
