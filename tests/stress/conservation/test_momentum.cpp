/// Momentum maps of a free tree over 1e5 steps, and the same tree in a room that moves (numerics 5 no. 1, 5).
#include <gtest/gtest.h>

#include <iostream>

#include "multibody/registry.hpp"
#include "stress/energy_history.hpp"
#include "support/figure.hpp"
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
  test::EnergyHistory history(*model, 100'000);
  const test::Run done =
      test::run(*model, test::state_at(*model, model->manifold->reference(), rates), {.dt = 5.0, .steps = 100'000},
                [&](const variational::NodeRecord& node) {
                  if (node.step == 0) {
                    linear = node.values.linear_momentum;
                    angular = node.values.angular_momentum;
                  }
                  linear_error = std::max(linear_error, (node.values.linear_momentum - linear).norm());
                  angular_error = std::max(angular_error, (node.values.angular_momentum - angular).norm());
                  history.add(node);
                });
  ASSERT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
  std::cout << "linear " << linear_error / linear.norm() << ", angular " << angular_error / angular.norm()
            << ", violation " << history.violation() << ", rotation " << done.result.statistics.largest_rotation
            << '\n';
  test::record_figure("5", "free tree, 1e5 steps, linear momentum, relative", linear_error / linear.norm(), 1e-10);
  test::record_figure("5", "free tree, 1e5 steps, angular momentum, relative", angular_error / angular.norm(), 1e-10);
  test::record_figure("6", "free tree, 1e5 steps, violation of constraints", history.violation(), 1e-11);
  // It flies 110 m: the spacing of numbers there is a thousand times that at the start.
  test::record_figure("6", "free tree, 1e5 steps, violation of the last tenth over that of the first",
                      history.violation_growth(), test::root_of_ten);
}

TEST(MomentumMaps, AFreeTreeInAMovingRoomMovesTheSame) {
  const auto model = test::make_model(free_tree());
  std::mt19937 random(9);
  const Eigen::VectorXd rates = test::random_entries(random, 12, 0.01);
  const Vector3d drift(0.3, -0.2, 0.5);
  Eigen::VectorXd boosted = rates;
  boosted.head(3) += drift;
  const test::RunSetup setup{.dt = 5.0, .steps = 200, .step = {.tolerance = 1e-13}};
  const Eigen::VectorXd x = model->manifold->reference();
  const test::Run at_rest = test::run(*model, test::state_at(*model, x, rates), setup);
  const test::Run moving = test::run(*model, test::state_at(*model, x, boosted), setup);
  ASSERT_EQ(moving.result.status, variational::Status::completed) << moving.result.sentence;
  double largest = 0.0;
  for (Eigen::Index k = 0; k < at_rest.state.q.size(); k += 3) {
    Vector3d expected = at_rest.state.q.segment<3>(k);
    if (k % 12 == 0) expected += moving.state.t * drift;
    largest = std::max(largest, (moving.state.q.segment<3>(k) - expected).lpNorm<Eigen::Infinity>());
  }
  // Sizes of 100 mm.
  test::record_figure("1", "free tree in a room that moves, largest error over its size", largest / 100.0, 1e-9);
}

}  // namespace
}  // namespace muldi
