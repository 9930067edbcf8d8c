/// tree = dense = bordered, for any pattern that each of them takes.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "multibody/registry.hpp"
#include "support/random_tree.hpp"

namespace muldi::multibody {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A nonsymmetric tangent with the entries of bodies of 10 g and 30 mm, far from singular.
math::BlockMatrix random_tangent(std::mt19937& random, const math::BlockPattern& pattern) {
  math::BlockMatrix K(pattern);
  std::uniform_real_distribution<double> in(-0.3, 0.3);
  const auto size = [](Eigen::Index k) { return k < 3 ? std::sqrt(10.0) : 100.0; };
  for (int i = 0; i < pattern.n_nodes(); ++i) {
    for (const int j : pattern.columns(i)) {
      auto block = K.block(i, j);
      for (Eigen::Index r = 0; r < block.rows(); ++r) {
        for (Eigen::Index c = 0; c < block.cols(); ++c) {
          block(r, c) = size(r) * size(c) * (in(random) + (i == j && r == c ? 6.0 : 0.0));
        }
      }
    }
  }
  return K;
}

/// Coordinates a step away: 0.2 rad and a twentieth of the scene at most.
VectorXd one_step_on(std::mt19937& random, const TreeManifold& manifold, const VectorXd& x) {
  VectorXd x_new = x;
  const VectorXd scale = manifold.rate_scale().unaryExpr([](double s) { return s > 1.0 ? 0.05 * s : 0.2; });
  manifold.retract(x, test::random_entries(random, manifold.n_v(), 1.0).cwiseProduct(scale), x_new);
  return x_new;
}

struct Solution {
  VectorXd w;
  VectorXd lambda;
};

/// T_l^T K T_r + diagonal.
struct Tangent {
  MatrixXd K;
  VectorXd diagonal;
};

/// The system written out with dense matrices; Z of the first frame.
Solution reference(const TreeManifold& manifold, const std::array<VectorXd, 2>& x, const Tangent& tangent,
                   const MatrixXd& Z, const Solution& rhs) {
  const MatrixXd T_l = test::dense_null_space(manifold, x[0]);
  const MatrixXd T_r = test::dense_null_space(manifold, x[1]);
  const MatrixXd G_l =
      Z.transpose() * test::dense_jacobian(manifold.loop_rows(), test::configuration_at(manifold, x[0]));
  const MatrixXd G_r =
      Z.transpose() * test::dense_jacobian(manifold.loop_rows(), test::configuration_at(manifold, x[1]));
  const Eigen::Index n_v = T_l.cols();
  const Eigen::Index n_c = G_l.rows();
  MatrixXd matrix = MatrixXd::Zero(n_v + n_c, n_v + n_c);
  matrix.topLeftCorner(n_v, n_v) = T_l.transpose() * tangent.K * T_r;
  matrix.topLeftCorner(n_v, n_v).diagonal() += tangent.diagonal;
  matrix.topRightCorner(n_v, n_c) = (G_l * T_l).transpose();
  matrix.bottomLeftCorner(n_c, n_v) = G_r * T_r;
  VectorXd right(n_v + n_c);
  right << rhs.w, rhs.lambda;
  // Inertias and constraint rows differ by eight powers of ten: scaled to ones on the diagonal and in every row.
  VectorXd scale(n_v + n_c);
  for (Eigen::Index k = 0; k < n_v; ++k) scale[k] = 1.0 / std::sqrt(std::abs(matrix(k, k)));
  for (Eigen::Index k = n_v; k < n_v + n_c; ++k) {
    scale[k] = 1.0 / matrix.row(k).head(n_v).transpose().cwiseProduct(scale.head(n_v)).norm();
  }
  const VectorXd solution = scale.cwiseProduct(
      (scale.asDiagonal() * matrix * scale.asDiagonal()).fullPivLu().solve(scale.cwiseProduct(right)));
  return {solution.head(n_v), solution.tail(n_c)};
}

void expect_same(std::mt19937& random, const test::RigidSystem& system, const std::vector<std::string>& kinds) {
  const auto model = test::make_model(system);
  const TreeManifold& manifold = test::manifold_of(*model);
  const math::BlockMatrix K = random_tangent(random, *model->pattern);
  // Joints as stiff as 1 mJ or as 1 N/mm: of the size of the inertias.
  const VectorXd diagonal =
      test::random_entries(random, manifold.n_v(), 1.0)
          .cwiseAbs()
          .cwiseProduct(manifold.rate_scale().unaryExpr([](double s) { return s > 1.0 ? 5.0 : 1e4; }));
  const VectorXd x_0 = test::random_coordinates(random, manifold);
  const std::array<VectorXd, 2> x{x_0, one_step_on(random, manifold, x_0)};
  const Solution rhs{test::random_entries(random, manifold.n_v(), 1.0),
                     test::random_entries(random, manifold.n_c(), 1.0)};
  const auto left = manifold.make_frame();
  const auto right = manifold.make_frame();
  manifold.update(x[0], test::configuration_at(manifold, x[0]), *left);
  manifold.update(x[1], test::configuration_at(manifold, x[1]), *right);
  manifold.choose_loop_rows(*left);
  const Solution expected = reference(manifold, x, {K.dense(), diagonal}, manifold.loop_basis(*left), rhs);
  for (const std::string& kind : kinds) {
    const auto solver = manifold.make_solver(*model->pattern, kind);
    ASSERT_EQ(solver->name(), kind);
    ASSERT_TRUE(solver->factorise(*left, *right, K, diagonal));
    Solution at{VectorXd(manifold.n_v()), VectorXd(manifold.n_c())};
    solver->solve(rhs.w, rhs.lambda, at.w, at.lambda);
    ASSERT_LT((at.w - expected.w).norm(), 1e-10 * expected.w.norm()) << kind;
    ASSERT_LE((at.lambda - expected.lambda).norm(), 1e-10 * expected.lambda.norm()) << kind;
  }
}

/// A spring from every body to its parent.
void couple_neighbours(test::RigidSystem& system) {
  const KinematicTree tree = build_tree(system.n_bodies(), system.joints);
  for (const TreeLink& link : tree.links) {
    system.springs.push_back({.name = "s",
                              .element = {.stiffness = 1.0},
                              .a1 = {link.body, Eigen::Vector3d(1.0, 2.0, 3.0)},
                              .a2 = {link.parent, Eigen::Vector3d(200.0, -1.0, 2.0)}});
  }
}

void couple_far(std::mt19937& random, test::RigidSystem& system, int n_springs) {
  for (int n = 0; n < n_springs; ++n) {
    const std::vector<int> order = test::random_order(random, system.n_bodies());
    system.springs.push_back({.name = "f",
                              .element = {.stiffness = 1.0},
                              .a1 = {order[0], Eigen::Vector3d(1.0, 2.0, 3.0)},
                              .a2 = {order[1], Eigen::Vector3d(0.0, -1.0, 2.0)}});
  }
}

test::RigidSystem any_forest(std::mt19937& random) {
  return test::random_forest(random, {.n_bodies = 8, .n_chains = 2, .with_fixed_joints = true});
}

TEST(ProjectedSolvers, AgreeOnTrees) {
  std::mt19937 random(11);
  for (int n = 0; n < 50; ++n) {
    test::RigidSystem system = any_forest(random);
    if (n % 5 != 0) couple_neighbours(system);
    expect_same(random, system, {"tree", "dense", "bordered"});
  }
}

TEST(ProjectedSolvers, AgreeOnTreesWithSingleUnknowns) {
  std::mt19937 random(12);
  for (int n = 0; n < 10; ++n) {
    test::RigidSystem system = any_forest(random);
    couple_neighbours(system);
    for (int k = 0; k < 3; ++k) {
      system.actuators.push_back({.name = "a", .element = {.length = 2.0 + k}, .controls = {}});
    }
    expect_same(random, system, {"tree", "dense", "bordered"});
  }
}

TEST(ProjectedSolvers, AgreeWhereFarBodiesAreCoupled) {
  std::mt19937 random(13);
  for (int n = 0; n < 50; ++n) {
    test::RigidSystem system = any_forest(random);
    couple_neighbours(system);
    couple_far(random, system, 3);
    expect_same(random, system, {"dense", "bordered"});
  }
}

TEST(ProjectedSolvers, AgreeOnLoops) {
  std::mt19937 random(14);
  for (int n = 0; n < 50; ++n) {
    test::RigidSystem system = any_forest(random);
    couple_neighbours(system);
    if (n % 2 == 0) couple_far(random, system, 2);
    const std::vector<int> order = test::random_order(random, system.n_bodies());
    system.connect(n % 3 == 0 ? Revolute::pattern : Spherical::pattern, {order[0], order[1]},
                   test::random_vector(random, 50.0), test::random_rotation(random));
    expect_same(random, system, {"dense", "bordered"});
  }
}

TEST(ProjectedSolvers, TreeRefusesFarCouplingsAndLoops) {
  std::mt19937 random(15);
  test::RigidSystem far = test::random_forest(random, {.n_bodies = 3, .n_chains = 3});
  couple_far(random, far, 1);
  test::RigidSystem loop;
  loop.add_body(1.0, Eigen::Vector3d::Ones(), {});
  loop.connect(Revolute::pattern, {ground, 0}, Eigen::Vector3d(0.0, 0.0, 0.0));
  loop.connect(Planar::pattern, {ground, 0}, Eigen::Vector3d(10.0, 0.0, 0.0));
  loop.connect(Spherical::pattern, {ground, 0}, Eigen::Vector3d(10.0, 0.0, 0.0));
  for (const test::RigidSystem& system : {far, loop}) {
    const auto model = test::make_model(system);
    try {
      static_cast<void>(model->manifold->make_solver(*model->pattern, "tree"));
      ADD_FAILURE() << "no error";
    } catch (const base::InputError& error) {
      EXPECT_STREQ(error.what(),
                   "error: solver.linear: 'tree' needs a system without loops whose muscles and springs join "
                   "neighbours in the tree; use auto, dense or bordered");
    }
  }
}

TEST(ProjectedSolvers, AutoPicksByCouplingAndSize) {
  std::mt19937 random(16);
  test::RigidSystem system = test::random_forest(random, {.n_bodies = 4, .n_chains = 4});
  const auto local = test::make_model(system);
  EXPECT_EQ(local->manifold->make_solver(*local->pattern, "auto")->name(), "tree");
  couple_far(random, system, 1);
  const auto small = test::make_model(system);
  EXPECT_EQ(small->manifold->make_solver(*small->pattern, "auto")->name(), "dense");
  for (int n = 0; n < 20; ++n) system.add_body(1.0, Eigen::Vector3d::Ones(), {});
  const auto large = test::make_model(system);
  EXPECT_EQ(large->manifold->make_solver(*large->pattern, "auto")->name(), "bordered");
}

TEST(ProjectedSolvers, SayThatAMassMatrixIsSingular) {
  // A rod without thickness on a ball joint turns freely about itself; in a random pose its inertia about that axis is
  // round-off, not zero.
  std::mt19937 random(17);
  for (int n = 0; n < 20; ++n) {
    test::RigidSystem system;
    const Eigen::Matrix3d axes = test::random_rotation(random);
    system.add_body(3.0, {0.0, 500.0, 500.0}, {.position = 20.0 * axes.col(0), .orientation = axes});
    system.connect(Spherical::pattern, {ground, 0}, Eigen::Vector3d::Zero(), test::random_rotation(random));
    const auto model = test::make_model(system);
    const auto frame = model->manifold->make_frame();
    const VectorXd q = test::configuration_at(*model->manifold, model->manifold->reference());
    model->manifold->update(model->manifold->reference(), q, *frame);
    math::BlockMatrix M(*model->pattern);
    const VectorXd v = VectorXd::Zero(12);
    model->tangent({.q0 = q, .q1 = q, .q = q, .v = v, .u = {}}, model::TangentWeights::mass(), M);
    for (const std::string kind : {"tree", "dense", "bordered"}) {
      EXPECT_FALSE(model->manifold->make_solver(*model->pattern, kind)->factorise(*frame, *frame, M)) << kind;
    }
  }
}

TEST(ProjectedSolvers, TakeMassRatiosOfAMillion) {
  std::mt19937 random(18);
  for (const double ratio : {1e-6, 1e6}) {
    test::RigidSystem system;
    system.add_body(1.0, {500.0, 600.0, 700.0}, test::random_pose(random, 50.0));
    system.add_body(ratio, ratio * Eigen::Vector3d(500.0, 600.0, 700.0), test::random_pose(random, 50.0));
    system.connect(Spherical::pattern, {ground, 0}, Eigen::Vector3d::Zero());
    system.connect(Universal::pattern, {0, 1}, Eigen::Vector3d(10.0, 20.0, 30.0));
    const auto model = test::make_model(system);
    const auto frame = model->manifold->make_frame();
    const VectorXd q = test::configuration_at(*model->manifold, model->manifold->reference());
    model->manifold->update(model->manifold->reference(), q, *frame);
    math::BlockMatrix M(*model->pattern);
    const VectorXd v = VectorXd::Zero(24);
    model->tangent({.q0 = q, .q1 = q, .q = q, .v = v, .u = {}}, model::TangentWeights::mass(), M);
    const MatrixXd T = test::dense_null_space(test::manifold_of(*model), model->manifold->reference());
    const VectorXd w = test::random_entries(random, 5, 1.0);
    const VectorXd r = T.transpose() * M.dense() * T * w;
    for (const std::string kind : {"tree", "dense", "bordered"}) {
      const auto solver = model->manifold->make_solver(*model->pattern, kind);
      ASSERT_TRUE(solver->factorise(*frame, *frame, M)) << kind;
      VectorXd at(5);
      VectorXd none(0);
      solver->solve(r, none, at, none);
      // The condition number is about that of the masses: 1e6 times round-off, and some.
      EXPECT_LT((at - w).norm(), 1e-8) << kind << " " << ratio;
    }
  }
}

}  // namespace
}  // namespace muldi::multibody
