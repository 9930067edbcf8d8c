/// Closed loops: rank, redundant rows, what cannot close (numerics 1.9).
#include <gtest/gtest.h>

#include <cmath>

#include "multibody/registry.hpp"
#include "support/linkages.hpp"
#include "support/random_tree.hpp"

namespace muldi::multibody {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

double regularity(const TreeManifold& manifold, const VectorXd& x) {
  const auto frame = manifold.make_frame();
  manifold.update(x, test::configuration_at(manifold, x), *frame);
  return manifold.loop_regularity(*frame);
}

TEST(Loops, FourBarKeepsTwoOfFiveRows) {
  const auto model = test::make_model(test::four_bar({}, 0.0));
  const TreeManifold& manifold = test::manifold_of(*model);
  EXPECT_EQ(manifold.n_v(), 3);
  EXPECT_EQ(manifold.n_c(), 2);
  EXPECT_EQ(manifold.redundant_rows().size(), 3u);
  EXPECT_EQ(manifold.tree().cut_joints.size(), 1u);
  EXPECT_LT(manifold.violation(test::configuration_at(manifold, manifold.reference())), 1e-14);
}

TEST(Loops, SliderCrankKeepsTwoRows) {
  const auto model = test::make_model(test::slider_crank(0.0));
  const TreeManifold& manifold = test::manifold_of(*model);
  EXPECT_EQ(manifold.n_v() - manifold.n_c(), 1);
  EXPECT_EQ(manifold.n_c(), 2);
}

TEST(Loops, BennettLinkageKeepsTwoOfFiveRows) {
  // Counted freely, 3 - 5 < 0 freedoms; Bennett's proportions leave one.
  const auto model = test::make_model(test::bennett(1.2));
  const TreeManifold& manifold = test::manifold_of(*model);
  ASSERT_LT(manifold.violation(test::configuration_at(manifold, manifold.reference())), 1e-14) << "the linkage closes";
  EXPECT_EQ(manifold.n_v(), 3);
  EXPECT_EQ(manifold.n_c(), 2);
}

TEST(Loops, ASpatialLoopWithOtherProportionsIsAStructure) {
  std::mt19937 random(31);
  test::RigidSystem system;
  for (int i = 0; i < 3; ++i) system.add_body(1.0, Vector3d::Ones(), test::random_pose(random, 50.0));
  for (int i = 0; i < 4; ++i) {
    system.connect(Revolute::pattern, {i == 0 ? ground : i - 1, i == 3 ? ground : i}, test::random_vector(random, 50.0),
                   test::random_rotation(random));
  }
  const auto model = test::make_model(system);
  EXPECT_EQ(model->manifold->n_v(), model->manifold->n_c());
}

TEST(Loops, JoinsOfWhatHoldsTogetherAlreadyAreAllRedundant) {
  // Two welds side by side, turned anyhow: the projected rows of the second are round-off, not constraints.
  std::mt19937 random(32);
  for (int n = 0; n < 20; ++n) {
    test::RigidSystem system;
    for (int i = 0; i < 2; ++i) system.add_body(1.0, Vector3d::Ones(), test::random_pose(random, 50.0));
    for (int i = 0; i < 2; ++i) {
      system.connect(Fixed::pattern, {0, 1}, test::random_vector(random, 50.0), test::random_rotation(random));
    }
    const auto model = test::make_model(system);
    EXPECT_EQ(model->manifold->n_v(), 6);
    EXPECT_EQ(model->manifold->n_c(), 0);
    EXPECT_EQ(test::manifold_of(*model).redundant_rows().size(), 6u);
  }
}

TEST(Loops, OfASystemThatCannotMoveAreRedundant) {
  test::RigidSystem system;
  system.add_body(1.0, Vector3d::Ones(), {});
  for (int i = 0; i < 2; ++i) system.connect(Fixed::pattern, {ground, 0}, Vector3d(i, 0.0, 0.0));
  const auto model = test::make_model(system);
  EXPECT_EQ(model->manifold->n_v(), 0);
  EXPECT_EQ(model->manifold->n_c(), 0);
}

TEST(Loops, RegularityFallsToZeroAtAChangePoint) {
  // A parallelogram of crank 30: all bars in line at crank angle 0.
  const test::FourBar form{.ground = 90.0, .crank = 30.0, .coupler = 90.0, .rocker = 30.0, .crank_angle = 1.0};
  const auto model = test::make_model(test::four_bar(form, 0.0));
  const TreeManifold& manifold = test::manifold_of(*model);
  // The bars stay parallel: crank and rocker turn by a, the coupler by -a against the crank, the rocker by a against
  // the coupler.
  const auto at = [&](double turn) {
    VectorXd x = manifold.reference();
    for (const TreeLink& link : manifold.tree().links) {
      x[link.first_coordinate] = link.joint == 1 ? -turn : turn;
    }
    return x;
  };
  EXPECT_LT(manifold.violation(test::configuration_at(manifold, at(-0.3))), 1e-14) << "the coordinates are right";
  EXPECT_GT(regularity(manifold, at(0.0)), 0.1);
  const double near = regularity(manifold, at(-0.999));
  const double nearer = regularity(manifold, at(-0.9999));
  EXPECT_LT(near, 2e-3);
  EXPECT_NEAR(near / nearer, 10.0, 0.1) << "linear in the distance";
  EXPECT_LT(regularity(manifold, at(-1.0)), 1e-14);
}

TEST(Loops, ProjectedRowsAreTheLoopJacobianTimesTheNullSpace) {
  const auto model = test::make_model(test::bennett(1.2));
  const TreeManifold& manifold = test::manifold_of(*model);
  const VectorXd x{{0.1, -0.2, 0.3}};
  const VectorXd q = test::configuration_at(manifold, x);
  const auto frame = manifold.make_frame();
  manifold.update(x, q, *frame);
  Eigen::MatrixXd B(manifold.n_c(), manifold.n_v());
  manifold.project_constraints(*frame, B);
  const Eigen::MatrixXd expected = test::dense_jacobian(manifold.loop_rows(), q) * test::dense_null_space(manifold, x);
  EXPECT_LT((B - expected).norm(), 1e-14);
  VectorXd f = VectorXd::Zero(manifold.n_q());
  const Eigen::Vector2d lambda(0.7, -1.1);
  manifold.add_constraint_forces(q, 2.0, lambda, f);
  VectorXd r(manifold.n_v());
  manifold.project(*frame, f, r);
  EXPECT_LT((r - 2.0 * B.transpose() * lambda).norm(), 1e-13);
}

}  // namespace
}  // namespace muldi::multibody
