#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <random>

#include "math/rotation.hpp"

namespace muldi::math {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double pi = std::numbers::pi;

Vector3d random_vector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> in(-size, size);
  const double x = in(random);
  const double y = in(random);
  return {x, y, in(random)};
}

/// Rodrigues: 1 + sin(a) hat(n) + (1 - cos(a)) hat(n)^2.
Matrix3d rodrigues(const Vector3d& w) {
  const double angle = w.norm();
  const Matrix3d n = hat(w / angle);
  return Matrix3d::Identity() + std::sin(angle) * n + (1.0 - std::cos(angle)) * n * n;
}

Vector4d exponential(const Vector3d& w) {
  Vector4d q;
  quaternion_exp(w, q.data());
  return q;
}

TEST(Rotation, HatIsTheCrossProduct) {
  const Vector3d a(1.0, -2.0, 3.0);
  const Vector3d b(0.3, 0.7, -0.2);
  EXPECT_LT((hat(a) * b - a.cross(b)).norm(), 1e-15);
}

TEST(Rotation, AboutAnAxisTurnsTheNextAxisTowardsTheOneAfter) {
  for (int axis = 0; axis < 3; ++axis) {
    const Matrix3d R = axis_rotation(axis, 0.5 * pi);
    EXPECT_LT((R * Vector3d::Unit((axis + 1) % 3) - Vector3d::Unit((axis + 2) % 3)).norm(), 1e-15);
    EXPECT_LT((axis_rotation(axis, 0.3) - rodrigues(0.3 * Vector3d::Unit(axis))).norm(), 1e-15);
    EXPECT_LT((rotation_about(5.0 * Vector3d::Unit(axis), 0.3) - axis_rotation(axis, 0.3)).norm(), 1e-15);
  }
}

TEST(Rotation, FixedAxesTurnAboutXThenYThenZ) {
  const Matrix3d R = rotation_from_fixed_axes({0.5 * pi, 0.0, 0.5 * pi});
  // y goes to z by the first turn and stays; x goes to y by the last.
  EXPECT_LT((R * Vector3d::UnitY() - Vector3d::UnitZ()).norm(), 1e-15);
  EXPECT_LT((R * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-15);
}

TEST(Rotation, ExponentialIsRodrigues) {
  std::mt19937 random(2);
  for (int n = 0; n < 50; ++n) {
    const Vector3d w = random_vector(random, 4.0);
    const Vector4d q = exponential(w);
    EXPECT_NEAR(q.norm(), 1.0, 1e-15);
    EXPECT_LT((quaternion_matrix(q.data()) - rodrigues(w)).norm(), 1e-14);
  }
}

TEST(Rotation, ExponentialOfSmallVectorsIsExactToRoundOff) {
  for (const double size : {0.0, 1e-300, 1e-12, 1e-5, 1.9e-4, 2.1e-4, 1e-3}) {
    const Vector3d w = size * Vector3d(1.0, 2.0, -2.0) / 3.0;
    const Vector4d q = exponential(w);
    EXPECT_NEAR(q.norm(), 1.0, 1e-15);
    const Vector3d expected = std::sin(0.5 * size) * Vector3d(1.0, 2.0, -2.0) / 3.0;
    EXPECT_LE((q.tail<3>() - expected).norm(), 1e-15 * size);
    EXPECT_LE((quaternion_log(q.data()) - w).norm(), 4e-16 * size);
  }
}

TEST(Rotation, LogarithmIsTheShortestVector) {
  const Vector3d n = Vector3d(1.0, 2.0, -2.0) / 3.0;
  for (const double angle : {1e-9, 0.5, 3.0, pi - 1e-9}) {
    EXPECT_LT((quaternion_log(exponential(angle * n).data()) - angle * n).norm(), 1e-14);
    const Vector4d other_sign = -exponential(angle * n);
    EXPECT_LT((quaternion_log(other_sign.data()) - angle * n).norm(), 1e-14);
  }
  // Beyond half a turn the other way round is shorter.
  EXPECT_LT((quaternion_log(exponential(4.0 * n).data()) - (4.0 - 2.0 * pi) * n).norm(), 1e-14);
}

TEST(Rotation, QuaternionOfAMatrixIsItsInverseForAnyTurn) {
  std::mt19937 random(3);
  for (int n = 0; n < 200; ++n) {
    Vector3d w = random_vector(random, 1.0).normalized();
    w *= n < 100 ? 0.031 * n : pi - 1e-3 * (n - 100);  // near half a turn too, where w is near 0
    Vector4d q;
    const Matrix3d R = rodrigues(w.norm() > 0.0 ? w : Vector3d(1e-12, 0.0, 0.0));
    matrix_quaternion(R, q.data());
    EXPECT_GE(q[0], 0.0);
    EXPECT_LT((quaternion_matrix(q.data()) - R).norm(), 1e-14);
  }
}

TEST(Rotation, AdvanceMultipliesFromTheLeftAndMayAlias) {
  const Vector3d w(0.3, -0.2, 0.5);
  Vector4d q = exponential({1.0, 0.4, -0.6});
  Vector4d moved;
  quaternion_advance(q.data(), w, moved.data());
  EXPECT_LT((quaternion_matrix(moved.data()) - rodrigues(w) * quaternion_matrix(q.data())).norm(), 1e-15);
  EXPECT_LT((quaternion_difference(q.data(), moved.data()) - w).norm(), 1e-15);
  quaternion_advance(q.data(), w, q.data());
  EXPECT_EQ(q, moved);
}

TEST(Rotation, AdvanceKeepsTheNormOverManySteps) {
  Vector4d q = exponential({1.0, 0.4, -0.6});
  for (int n = 0; n < 100000; ++n) quaternion_advance(q.data(), {0.01, 0.02, -0.03}, q.data());
  EXPECT_NEAR(q.norm(), 1.0, 1e-15);
}

TEST(Rotation, TriadAboutAnAxisIsRightHandedAndOrthonormal) {
  std::mt19937 random(4);
  for (int n = 0; n < 50; ++n) {
    const Vector3d axis = n < 3 ? Vector3d(Vector3d::Unit(n)) : random_vector(random, 3.0);
    const Matrix3d triad = triad_about(axis);
    EXPECT_LT((triad.col(2) - axis.normalized()).norm(), 1e-15);
    EXPECT_LT((triad.transpose() * triad - Matrix3d::Identity()).norm(), 1e-15);
    EXPECT_NEAR(triad.determinant(), 1.0, 1e-15);
  }
}

}  // namespace
}  // namespace muldi::math
