/// 200 random systems: any numbering, joint types, orientations, directions, anchored and free (numerics 5 no. 22).
#include <gtest/gtest.h>

#include "support/figure.hpp"
#include "support/random_tree.hpp"
#include "support/trajectory.hpp"

namespace muldi::multibody {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

test::RigidSystem any_forest(std::mt19937& random) {
  std::uniform_int_distribution<int> bodies(1, 12);
  std::uniform_int_distribution<int> chains(1, 4);
  const int n_bodies = bodies(random);
  return test::random_forest(
      random, {.n_bodies = n_bodies, .n_chains = std::min(n_bodies, chains(random)), .with_fixed_joints = true});
}

TEST(RandomTrees, NullSpaceMatrixIsAnnihilatedByAllConstraints) {
  std::mt19937 random(200);
  double largest = 0.0;
  for (int n = 0; n < 200; ++n) {
    const auto model = test::make_model(any_forest(random));
    const TreeManifold& manifold = test::manifold_of(*model);
    const VectorXd x = test::random_coordinates(random, manifold);
    const VectorXd q = test::configuration_at(manifold, x);
    const MatrixXd GT = test::dense_jacobian(manifold.tree_rows(), q) * test::dense_null_space(manifold, x);
    if (GT.size() > 0) largest = std::max(largest, GT.lpNorm<Eigen::Infinity>());
    ASSERT_LT(manifold.violation(q), 1e-13);
  }
  test::record_figure("22", "200 random trees, max |G T|", largest, 1e-12);
}

TEST(RandomTrees, FreedomsAreTwelvePerBodyLessAllConstraints) {
  std::mt19937 random(201);
  for (int n = 0; n < 200; ++n) {
    const test::RigidSystem system = any_forest(random);
    const auto model = test::make_model(system);
    const TreeManifold& manifold = test::manifold_of(*model);
    int n_constraints = 6 * system.n_bodies();
    for (const Joint& joint : system.joints) n_constraints += joint.pattern.n_constraints();
    ASSERT_EQ(manifold.n_v(), 12 * system.n_bodies() - n_constraints);
    ASSERT_EQ(manifold.n_c(), 0);
    ASSERT_EQ(static_cast<int>(manifold.tree_rows().size()), n_constraints);
  }
}

TEST(RandomTrees, ProjectIsTheTransposeOfLift) {
  std::mt19937 random(202);
  for (int n = 0; n < 50; ++n) {
    const auto model = test::make_model(any_forest(random));
    const TreeManifold& manifold = test::manifold_of(*model);
    const VectorXd x = test::random_coordinates(random, manifold);
    const VectorXd q = test::configuration_at(manifold, x);
    const auto frame = manifold.make_frame();
    manifold.update(x, q, *frame);
    const VectorXd w = test::random_entries(random, manifold.n_v(), 1.0);
    const VectorXd f = test::random_entries(random, manifold.n_q(), 1.0);
    VectorXd r(manifold.n_v());
    VectorXd dq(manifold.n_q());
    manifold.project(*frame, f, r);
    manifold.lift(*frame, w, dq);
    ASSERT_NEAR(r.dot(w), f.dot(dq), 1e-11 * (1.0 + dq.norm()));
  }
}

/// Positions and directors of all bodies, in the numbering of the original system.
VectorXd by_original_body(const VectorXd& q, const std::vector<int>& order) {
  VectorXd result(q.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    result.segment<12>(12 * order[i]) = q.segment<12>(12 * static_cast<Eigen::Index>(i));
  }
  return result;
}

TEST(RandomTrees, MotionDoesNotDependOnTheNumbering) {
  // 20 steps from rest under gravity and a spring; sizes of 100 mm, hence 1e-8 mm for the relative 1e-10.
  std::mt19937 random(203);
  for (int n = 0; n < 30; ++n) {
    test::RigidSystem system = test::random_forest(random, {.n_bodies = 7, .n_chains = 2});
    system.springs.push_back({.name = "s",
                              .element = {.stiffness = 2e-4, .rest_length = 20.0},
                              .a1 = {0, Eigen::Vector3d(1.0, 2.0, 3.0)},
                              .a2 = {5, Eigen::Vector3d(3.0, -1.0, 4.0)}});
    const std::vector<int> bodies = test::random_order(random, system.n_bodies());
    const std::vector<int> joints = test::random_order(random, static_cast<int>(system.joints.size()));
    const auto model = test::make_model(system);
    const auto other = test::make_model(test::renumbered(system, bodies, joints));
    const test::Run run = test::run(*model, test::state_at_rest(*model), {.dt = 1.0, .steps = 20});
    const test::Run again = test::run(*other, test::state_at_rest(*other), {.dt = 1.0, .steps = 20});
    ASSERT_EQ(run.result.status, variational::Status::completed) << run.result.sentence;
    ASSERT_EQ(again.result.status, variational::Status::completed) << again.result.sentence;
    ASSERT_GT((run.state.q - test::state_at_rest(*model).q).norm(), 1e-2) << "it moves";
    ASSERT_LT((by_original_body(again.state.q, bodies) - run.state.q).lpNorm<Eigen::Infinity>(), 1e-8);
    ASSERT_LT((by_original_body(again.state.p, bodies) - run.state.p).norm(), 1e-10 * run.state.p.norm());
  }
}

}  // namespace
}  // namespace muldi::multibody
