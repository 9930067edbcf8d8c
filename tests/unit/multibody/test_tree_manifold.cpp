#include <gtest/gtest.h>

#include <cmath>

#include "math/rotation.hpp"
#include "multibody/registry.hpp"
#include "support/random_tree.hpp"
#include "support/systems.hpp"

namespace muldi::multibody {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

TEST(TreeManifold, SizesCountBodiesJointsAndSingleUnknowns) {
  test::RigidSystem system = test::double_pendulum();
  system.actuators = test::membrane(0.0, 0.0).actuators;
  const auto model = test::make_model(system);
  const TreeManifold& manifold = test::manifold_of(*model);
  EXPECT_EQ(manifold.n_q(), 25);
  EXPECT_EQ(manifold.n_x(), 3);
  EXPECT_EQ(manifold.n_v(), 3);
  EXPECT_EQ(manifold.n_c(), 0);
  EXPECT_EQ(manifold.reference(), (VectorXd(3) << 0.0, 0.0, 1.0).finished());
}

TEST(TreeManifold, SingleUnknownsMoveByThemselves) {
  test::RigidSystem system = test::pendulum();
  system.actuators = test::round_actuator(0.0, 0.0).actuators;
  const auto model = test::make_model(system);
  const TreeManifold& manifold = test::manifold_of(*model);
  VectorXd x = manifold.reference();
  manifold.retract(x, Eigen::Vector2d(0.5, -2.0), x);
  EXPECT_EQ(x, Eigen::Vector2d(0.5, 38.0));
  EXPECT_EQ(test::configuration_at(manifold, x)[12], 38.0);
  const Eigen::MatrixXd T = test::dense_null_space(manifold, x);
  EXPECT_EQ(T(12, 1), 1.0);
  EXPECT_EQ(T(12, 0), 0.0);
  EXPECT_EQ(T.col(1).head(12).norm(), 0.0);
}

TEST(TreeManifold, ScalesAnglesByOneAndLengthsByTheScene) {
  test::RigidSystem system;
  system.length = 70.0;
  system.add_body(1.0, Vector3d::Ones(), {});
  system.add_body(1.0, Vector3d::Ones(), {});
  system.connect(Planar::pattern, {ground, 0}, Vector3d::Zero());
  system.connect(Spherical::pattern, {0, 1}, Vector3d::Zero());
  system.actuators = test::round_actuator(0.0, 0.0).actuators;
  const auto model = test::make_model(system);
  EXPECT_EQ(model->manifold->rate_scale(), (VectorXd(7) << 70.0, 70.0, 1.0, 1.0, 1.0, 1.0, 40.0).finished());
}

TEST(TreeManifold, MeasuresTheLargestTurnOfABody) {
  test::RigidSystem system;
  for (int i = 0; i < 2; ++i) {
    system.add_body(1.0, Vector3d::Ones(), {.orientation = math::rotation_about({1.0, 2.0, 3.0}, 0.4 + i)});
  }
  const auto model = test::make_model(system);
  for (const double angle : {1e-8, 0.3, 2.0, 3.1}) {
    test::RigidSystem turned = system;
    turned.poses[0].orientation = math::rotation_about({0.0, 1.0, 1.0}, 0.1 * angle) * system.poses[0].orientation;
    turned.poses[1].orientation = math::rotation_about({3.0, 1.0, -1.0}, angle) * system.poses[1].orientation;
    const auto other = test::make_model(turned);
    const TreeManifold& manifold = test::manifold_of(*model);
    const VectorXd from = test::configuration_at(manifold, manifold.reference());
    const model::Turn turn =
        manifold.largest_turn(from, test::configuration_at(*other->manifold, other->manifold->reference()));
    EXPECT_NEAR(turn.angle, angle, 1e-14 + 1e-13 * angle);
    EXPECT_EQ(turn.node, 1);
    EXPECT_EQ(manifold.largest_turn(from, from).node, -1);
  }
}

TEST(TreeManifold, ViolationTellsGapsInSizesOfTheScene) {
  const auto model = test::make_model(test::pendulum());  // length 92
  VectorXd q = test::configuration_at(*model->manifold, model->manifold->reference());
  q[1] += 0.92;
  EXPECT_NEAR(model->manifold->violation(q), 0.01, 1e-15);
  q[1] -= 0.92;
  q.segment<3>(3) *= 1.001;
  EXPECT_NEAR(model->manifold->violation(q), 0.5 * (1.001 * 1.001 - 1.0), 1e-15);
}

TEST(TreeManifold, RebuildsOrthonormalDirectorsAfterManyJoints) {
  // Fifty bodies: orientations are products of fifty rotations.
  const auto model = test::make_model(test::revolute_chain(50));
  std::mt19937 random(6);
  for (int n = 0; n < 20; ++n) {
    const VectorXd x = test::random_entries(random, 50, 20.0);
    EXPECT_LT(model->manifold->violation(test::configuration_at(*model->manifold, x)), 5e-14);
  }
}

TEST(TreeManifold, WithoutLoopsIsRegular) {
  const auto model = test::make_model(test::pendulum());
  const auto frame = model->manifold->make_frame();
  const model::LoopRank rank = model->manifold->choose_loop_rows(*frame);
  EXPECT_EQ(rank.regularity, 1.0);
  EXPECT_EQ(rank.excess, 0.0);
}

TEST(TreeManifold, ForcesOnRatesAreForcesBetweenBodies) {
  std::mt19937 random(46);
  for (int n = 0; n < 30; ++n) {
    test::RigidSystem system = test::random_forest(random, {.n_bodies = 6, .n_chains = 2, .with_fixed_joints = true});
    system.actuators.push_back({.name = "a", .element = {}, .controls = {}});
    const auto model = test::make_model(system);
    const TreeManifold& manifold = test::manifold_of(*model);
    const VectorXd x = test::random_coordinates(random, manifold);
    const VectorXd q = test::configuration_at(manifold, x);
    const auto frame = manifold.make_frame();
    manifold.update(x, q, *frame);
    VectorXd on_rates = test::random_entries(random, manifold.n_v(), 1.0);
    const VectorXd before = test::random_entries(random, manifold.n_q(), 1.0);
    VectorXd f = before;
    manifold.add_forces_on_rates(*frame, 0.3, on_rates, f);
    const VectorXd projected = test::dense_null_space(manifold, x).transpose() * (f - before);
    EXPECT_LT((projected - 0.3 * on_rates).norm(), 1e-11 * on_rates.norm());
    // Without the drives that act from ground no force and no moment is left over.
    for (const TreeLink& link : manifold.tree().links) {
      if (link.parent == ground)
        on_rates.segment(link.first_rate, manifold.tree().joint(link).pattern.n_rates()).setZero();
    }
    f.setZero();
    manifold.add_forces_on_rates(*frame, 1.0, on_rates, f);
    Eigen::Vector3d force;
    Eigen::Vector3d moment;
    model->momentum_maps(q, f, force, moment);
    EXPECT_LT(force.norm(), 1e-13);
    EXPECT_LT(moment.norm(), 1e-11);
  }
}

}  // namespace
}  // namespace muldi::multibody
