/// The curvature of the manifold: derivatives of T(q)^T f along minimal increments, and of the loop rows.
#include <gtest/gtest.h>

#include "math/derivative_check.hpp"
#include "multibody/registry.hpp"
#include "support/linkages.hpp"
#include "support/random_tree.hpp"

namespace muldi::multibody {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// T(q(x + w))^T (f - G(q(x + w))^T lambda) as a function of w.
VectorXd projected(const TreeManifold& manifold, const VectorXd& x, const VectorXd& w, const VectorXd& f,
                   const VectorXd& lambda) {
  VectorXd x_new = x;
  manifold.retract(x, w, x_new);
  const VectorXd q = test::configuration_at(manifold, x_new);
  const auto frame = manifold.make_frame();
  manifold.update(x_new, q, *frame);
  VectorXd total = f;
  manifold.add_constraint_forces(q, -1.0, lambda, total);
  VectorXd r(manifold.n_v());
  manifold.project(*frame, total, r);
  return r;
}

void expect_curvature(std::mt19937& random, const test::RigidSystem& system, double tolerance) {
  const auto model = test::make_model(system);
  const TreeManifold& manifold = test::manifold_of(*model);
  const VectorXd x = test::random_coordinates(random, manifold);
  const VectorXd f = test::random_entries(random, manifold.n_q(), 1.0);
  const VectorXd lambda = test::random_entries(random, manifold.n_loop_rows(), 30.0);
  const VectorXd q = test::configuration_at(manifold, x);
  const auto frame = manifold.make_frame();
  manifold.update(x, q, *frame);
  VectorXd total = f;
  manifold.add_constraint_forces(q, -1.0, lambda, total);
  MatrixXd A = MatrixXd::Zero(manifold.n_v(), manifold.n_v());
  manifold.add_curvature(*frame, total, lambda, A);
  const auto function = [&](const VectorXd& w) { return projected(manifold, x, w, f, lambda); };
  const VectorXd zero = VectorXd::Zero(manifold.n_v());
  const MatrixXd expected = -math::difference_jacobian(function, zero, 0.02 * manifold.rate_scale().cwiseMin(1.0));
  EXPECT_LT(math::derivative_error(A, expected).relative, tolerance);
}

TEST(Curvature, OfEveryJointTypeAndDirection) {
  std::mt19937 random(80);
  for (const JointPattern& pattern : test::joint_patterns()) {
    for (const auto& ends : {std::pair(0, 1), std::pair(1, 0)}) {
      test::RigidSystem system;
      for (int i = 0; i < 2; ++i) system.add_body(1.0, Eigen::Vector3d::Ones(), test::random_pose(random, 50.0));
      system.connect(pattern, ends, test::random_vector(random, 50.0), test::random_rotation(random));
      expect_curvature(random, system, 1e-10);
    }
  }
}

TEST(Curvature, OfRandomTrees) {
  std::mt19937 random(81);
  for (int n = 0; n < 20; ++n) {
    expect_curvature(random, test::random_forest(random, {.n_bodies = 7, .n_chains = 2, .with_fixed_joints = true}),
                     1e-10);
  }
}

TEST(Curvature, OfLoopsWithTheirMultipliers) {
  std::mt19937 random(82);
  expect_curvature(random, test::four_bar({}, 0.0), 1e-10);
  expect_curvature(random, test::slider_crank(0.0), 1e-10);
  expect_curvature(random, test::bennett(1.2), 1e-10);
  for (int n = 0; n < 10; ++n) {
    test::RigidSystem system = test::random_forest(random, {.n_bodies = 6, .n_chains = 1});
    system.connect(Spherical::pattern, {2, 5}, test::random_vector(random, 50.0), test::random_rotation(random));
    expect_curvature(random, system, 1e-10);
  }
}

TEST(Curvature, IsThatOfARotationInThePlane) {
  // One revolute joint: T^T f of a force (0, -1, 0) at the mass is -l cos(a), its slope l sin(a).
  test::RigidSystem system;
  system.add_body(1.0, Eigen::Vector3d::Ones(), {.position = Eigen::Vector3d(46.0, 0.0, 0.0)});
  system.connect(Revolute::pattern, {ground, 0}, Eigen::Vector3d::Zero());
  const auto model = test::make_model(system);
  const TreeManifold& manifold = test::manifold_of(*model);
  const VectorXd x = VectorXd::Constant(1, 0.7);
  const auto frame = manifold.make_frame();
  manifold.update(x, test::configuration_at(manifold, x), *frame);
  VectorXd f = VectorXd::Zero(12);
  f[1] = -1.0;
  MatrixXd A = MatrixXd::Zero(1, 1);
  manifold.add_curvature(*frame, f, VectorXd(), A);
  EXPECT_NEAR(A(0, 0), -46.0 * std::sin(0.7), 1e-13);
}

TEST(Curvature, SymmetricWhereForcesDeriveFromAPotential) {
  // The static tangent of a conservative tree is symmetric at an equilibrium of its balls, and everywhere for scalar
  // coordinates; here a constant force field, whose own tangent vanishes.
  std::mt19937 random(83);
  test::RigidSystem system;
  for (int i = 0; i < 4; ++i) {
    system.add_body(1.0, Eigen::Vector3d::Ones(), test::random_pose(random, 50.0));
    system.connect(i % 2 == 0 ? Universal::pattern : Cylindrical::pattern, {i - 1, i},
                   test::random_vector(random, 50.0), test::random_rotation(random));
  }
  const auto model = test::make_model(system);
  const TreeManifold& manifold = test::manifold_of(*model);
  const VectorXd x = test::random_coordinates(random, manifold);
  const auto frame = manifold.make_frame();
  manifold.update(x, test::configuration_at(manifold, x), *frame);
  const VectorXd f = test::random_entries(random, manifold.n_q(), 1.0);
  MatrixXd A = MatrixXd::Zero(manifold.n_v(), manifold.n_v());
  manifold.add_curvature(*frame, f, VectorXd(), A);
  EXPECT_LT((A - A.transpose()).norm(), 1e-12 * A.norm());
}

}  // namespace
}  // namespace muldi::multibody
