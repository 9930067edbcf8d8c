/// Closed loops: rank, redundant rows, what cannot close (numerics 1.9).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "multibody/registry.hpp"
#include "support/linkages.hpp"
#include "support/random_tree.hpp"

namespace muldi::multibody {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

std::unique_ptr<model::Frame> frame_at(const TreeManifold& manifold, const VectorXd& x) {
  auto frame = manifold.make_frame();
  manifold.update(x, test::configuration_at(manifold, x), *frame);
  return frame;
}

model::LoopRank rank_at(const TreeManifold& manifold, const VectorXd& x) {
  return manifold.choose_loop_rows(*frame_at(manifold, x));
}

double regularity(const TreeManifold& manifold, const VectorXd& x) { return rank_at(manifold, x).regularity; }

TEST(Loops, FourBarKeepsTwoOfFiveRows) {
  const auto model = test::make_model(test::four_bar({}, 0.0));
  const TreeManifold& manifold = test::manifold_of(*model);
  EXPECT_EQ(manifold.n_v(), 3);
  EXPECT_EQ(manifold.n_c(), 2);
  EXPECT_EQ(manifold.n_loop_rows(), 5);
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
    EXPECT_EQ(model->manifold->n_loop_rows(), 6);
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

/// B = G T of all loop rows.
Eigen::MatrixXd all_rows(const TreeManifold& manifold, const model::Frame& frame) {
  const int n = manifold.n_loop_rows();
  Eigen::MatrixXd B(n, manifold.n_v());
  manifold.project_constraints(frame, Eigen::MatrixXd::Identity(n, n), B);
  return B;
}

/// First angles of a Bennett linkage over a turn, off the places where its angle formula has poles.
std::vector<double> angles_of_a_turn(int n) {
  std::vector<double> angles;
  for (int i = 0; i < n; ++i) angles.push_back(2.0 * std::numbers::pi * (i + 0.5) / n);
  return angles;
}

TEST(Loops, BennettLinkageIsRegularWhereTwoOfItsRowsAreNot) {
  const auto model = test::make_model(test::bennett(1.0));
  const TreeManifold& manifold = test::manifold_of(*model);
  Eigen::Matrix<double, 5, 5> worst = Eigen::Matrix<double, 5, 5>::Ones();  // smaller over larger pivot of two rows
  for (const double angle : angles_of_a_turn(2000)) {
    const VectorXd x = test::bennett_coordinates(manifold, 1.0, angle);
    ASSERT_LT(manifold.violation(test::configuration_at(manifold, x)), 1e-13) << "the coordinates are right";
    const auto frame = frame_at(manifold, x);
    const model::LoopRank rank = manifold.choose_loop_rows(*frame);
    ASSERT_GT(rank.regularity, 0.25) << angle;
    ASSERT_LT(rank.excess, 1e-13) << angle;
    const Eigen::MatrixXd B = all_rows(manifold, *frame);
    for (int i = 0; i < 5; ++i) {
      for (int j = i + 1; j < 5; ++j) {
        const Vector3d a = B.row(i);
        const Vector3d b = B.row(j);
        worst(i, j) = std::min(worst(i, j), a.cross(b).norm() / std::max(a.squaredNorm(), b.squaredNorm()));
      }
    }
  }
  // Whichever two rows are kept, somewhere in a turn they lose rank.
  for (int i = 0; i < 5; ++i) {
    for (int j = i + 1; j < 5; ++j) EXPECT_LT(worst(i, j), 1e-2) << i << " and " << j;
  }
}

TEST(Loops, BasisIsOrthonormalAndSpansAllRows) {
  std::mt19937 random(33);
  const auto check = [](const TreeManifold& manifold, const VectorXd& x) {
    const auto frame = frame_at(manifold, x);
    manifold.choose_loop_rows(*frame);
    const Eigen::MatrixXd Z = manifold.loop_basis(*frame);
    const Eigen::MatrixXd B = all_rows(manifold, *frame);
    ASSERT_LT((Z.transpose() * Z - Eigen::MatrixXd::Identity(Z.cols(), Z.cols())).norm(), 1e-14);
    ASSERT_LT((Z * Z.transpose() * B - B).norm(), 1e-13 * B.norm());
    ASSERT_LT((static_cast<const TreeFrame&>(*frame).loop_rows - Z.transpose() * B).norm(), 1e-13 * B.norm());
  };
  const auto bennett = test::make_model(test::bennett(1.0));
  for (const double angle : angles_of_a_turn(50)) {
    const TreeManifold& manifold = test::manifold_of(*bennett);
    check(manifold, test::bennett_coordinates(manifold, 1.0, angle));
  }
  // Lengths beside angles, and one row more than the plane needs.
  const auto slider = test::make_model(test::slider_crank(0.0));
  check(test::manifold_of(*slider), slider->manifold->reference());
  // Rows that are all independent.
  test::RigidSystem system = test::random_forest(random, {.n_bodies = 6, .n_chains = 1});
  system.connect(Spherical::pattern, {2, 5}, test::random_vector(random, 50.0), test::random_rotation(random));
  const auto model = test::make_model(system);
  check(test::manifold_of(*model), test::random_coordinates(random, *model->manifold));
}

TEST(Loops, BasisIsThatOfTheConfigurationWhateverCameBefore) {
  const auto model = test::make_model(test::bennett(1.0));
  const TreeManifold& manifold = test::manifold_of(*model);
  const auto used = manifold.make_frame();
  for (const double angle : angles_of_a_turn(20)) {
    const VectorXd x = test::bennett_coordinates(manifold, 1.0, angle);
    const auto fresh = frame_at(manifold, x);
    manifold.update(x, test::configuration_at(manifold, x), *used);
    manifold.choose_loop_rows(*fresh);
    manifold.choose_loop_rows(*used);
    ASSERT_EQ(manifold.loop_basis(*fresh), manifold.loop_basis(*used)) << "bit for bit";
  }
}

TEST(Loops, CrossWhereTheProductsOfTheMinorsOfAllRowsSumUpBelowZero) {
  // Cauchy and Binet over all pairs of rows and of columns, far apart on purpose.
  const auto model = test::make_model(test::bennett(1.0));
  const TreeManifold& manifold = test::manifold_of(*model);
  int crossings = 0;
  for (const double from : angles_of_a_turn(12)) {
    for (const double to : angles_of_a_turn(13)) {
      const auto begin = frame_at(manifold, test::bennett_coordinates(manifold, 1.0, from));
      const auto end = frame_at(manifold, test::bennett_coordinates(manifold, 1.0, to));
      manifold.choose_loop_rows(*begin);
      const Eigen::MatrixXd B = all_rows(manifold, *begin);
      const Eigen::MatrixXd C = all_rows(manifold, *end);
      double sum = 0.0;
      for (int i = 0; i < 5; ++i) {
        for (int j = i + 1; j < 5; ++j) {
          sum += Vector3d(B.row(i)).cross(Vector3d(B.row(j))).dot(Vector3d(C.row(i)).cross(Vector3d(C.row(j))));
        }
      }
      ASSERT_EQ(manifold.loops_cross(*begin, *end), sum < 0.0) << from << " to " << to;
      crossings += sum < 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(crossings, 0);
}

TEST(Loops, OfAScenePoseAtAChangePointGainRankBesideIt) {
  // A parallelogram whose bars are in line in the scene pose: there one row holds, elsewhere two.
  const test::FourBar form{.ground = 90.0, .crank = 30.0, .coupler = 90.0, .rocker = 30.0, .crank_angle = 0.0};
  const auto model = test::make_model(test::four_bar(form, 0.0));
  const TreeManifold& manifold = test::manifold_of(*model);
  EXPECT_EQ(manifold.n_c(), 1);
  EXPECT_LT(rank_at(manifold, manifold.reference()).excess, 1e-14);
  VectorXd x = manifold.reference();
  for (const TreeLink& link : manifold.tree().links) x[link.first_coordinate] = link.joint == 1 ? -0.1 : 0.1;
  EXPECT_LT(manifold.violation(test::configuration_at(manifold, x)), 1e-14);
  EXPECT_GT(rank_at(manifold, x).excess, 1e-2);
}

TEST(Loops, ProjectedRowsAreTheLoopJacobianTimesTheNullSpace) {
  const auto model = test::make_model(test::bennett(1.2));
  const TreeManifold& manifold = test::manifold_of(*model);
  const VectorXd x{{0.1, -0.2, 0.3}};
  const VectorXd q = test::configuration_at(manifold, x);
  const auto frame = frame_at(manifold, x);
  const Eigen::MatrixXd each_row = Eigen::MatrixXd::Identity(5, 5);
  Eigen::MatrixXd B(5, manifold.n_v());
  manifold.project_constraints(*frame, each_row, B);
  const Eigen::MatrixXd expected = test::dense_jacobian(manifold.loop_rows(), q) * test::dense_null_space(manifold, x);
  EXPECT_LT((B - expected).norm(), 1e-14);
  VectorXd f = VectorXd::Zero(manifold.n_q());
  const VectorXd lambda{{0.7, -1.1, 0.4, 0.9, -0.3}};
  manifold.add_constraint_forces(q, 2.0, lambda, f);
  VectorXd r(manifold.n_v());
  manifold.project(*frame, f, r);
  EXPECT_LT((r - 2.0 * B.transpose() * lambda).norm(), 1e-13);
}

}  // namespace
}  // namespace muldi::multibody
