/// Momentum maps of a free tree over 1e5 steps (numerics 5 no. 5).
#include <gtest/gtest.h>

#include <iostream>

#include "multibody/registry.hpp"
#include "support/random_tree.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi {
namespace {

using Eigen::Vector3d;

/// Four bodies on a universal, a revolute and a spherical joint, springs between points off the joints, springs and a
/// damper in the joints.
test::RigidSystem free_tree() {
  test::RigidSystem system;
  std::mt19937 random(7);
  for (const Vector3d& at : {Vector3d(0, 0, 0), Vector3d(80, 0, 0), Vector3d(80, 80, 0), Vector3d(0, 0, 80)}) {
    system.add_body(40.0, Vector3d(2e4, 3e4, 4e4), {.position = at, .orientation = test::random_rotation(random)});
  }
  system.connect(multibody::Universal::pattern, {0, 1}, Vector3d(40.0, 0.0, 0.0), test::random_rotation(random));
  system.connect(multibody::Revolute::pattern, {2, 1}, Vector3d(80.0, 40.0, 0.0), test::random_rotation(random));
  system.connect(multibody::Spherical::pattern, {0, 3}, Vector3d(0.0, 0.0, 40.0));
  const auto spring = [&](int a, int b) {
    system.springs.push_back({.name = "spring" + std::to_string(system.springs.size()),
                              .element = {.stiffness = 0.02, .rest_length = 60.0},
                              .a1 = {a, Vector3d(5.0, 20.0, -10.0)},
                              .a2 = {b, Vector3d(-15.0, 10.0, 20.0)}});
  };
  spring(0, 2);
  spring(2, 3);
  spring(1, 3);
  spring(0, 1);
  system.joint_forces = {{.joint = 0, .motion = 0, .stiffness = 30.0, .rest = 0.3},
                         {.joint = 0, .motion = 1, .stiffness = 20.0, .damping = 5.0},
                         {.joint = 1, .stiffness = 50.0, .stops = {.lower = -0.2, .upper = 0.2, .stiffness = 40.0}}};
  return system;
}

TEST(MomentumMaps, OfAFreeTreeWithSpringsAreConserved) {
  const auto model = test::make_model(free_tree());
  ASSERT_EQ(model->manifold->n_v(), 12);
  std::mt19937 random(8);
  Eigen::VectorXd rates = test::random_entries(random, 12, 0.01);
  rates.head(3) *= 2.0;  // the first body's velocity, mm/ms
  Vector3d linear;
  Vector3d angular;
  double linear_error = 0.0;
  double angular_error = 0.0;
  double violation = 0.0;
  const test::Run done =
      test::run(*model, test::state_at(*model, model->manifold->reference(), rates), {.dt = 5.0, .steps = 100'000},
                [&](const variational::NodeRecord& node) {
                  if (node.step == 0) {
                    linear = node.values.linear_momentum;
                    angular = node.values.angular_momentum;
                  }
                  linear_error = std::max(linear_error, (node.values.linear_momentum - linear).norm());
                  angular_error = std::max(angular_error, (node.values.angular_momentum - angular).norm());
                  violation = std::max(violation, model->manifold->violation(node.state.q));
                });
  ASSERT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
  std::cout << "linear " << linear_error / linear.norm() << ", angular " << angular_error / angular.norm()
            << ", violation " << violation << ", rotation " << done.result.statistics.largest_rotation << '\n';
  EXPECT_LT(linear_error, 1e-10 * linear.norm());
  EXPECT_LT(angular_error, 1e-10 * angular.norm());
  EXPECT_LT(violation, 1e-11);
}

}  // namespace
}  // namespace muldi
