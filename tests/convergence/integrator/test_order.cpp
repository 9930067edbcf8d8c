/// The midpoint rule is of order 2 in positions, momenta, reactions and multipliers, all at nodes (numerics 5 no. 3).
#include <gtest/gtest.h>

#include <iostream>

#include "support/figure.hpp"
#include "support/linkages.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi::variational {
namespace {

using Eigen::VectorXd;
using test::RunSetup;

/// Binding: slope 2.00 +- 0.05.
constexpr double slack = 0.05;

void expect_order_two(const model::Model& model, const State& start, const RunSetup& setup) {
  const test::Orders orders = test::observed_orders(model, start, setup);
  test::record_near("3", "bodies and muscles, order of positions", orders.q, 2.0, slack);
  test::record_near("3", "bodies and muscles, order of momenta", orders.momentum, 2.0, slack);
  // Free lengths have no constraints, trees no multipliers.
  if (model.node_sizes[0] == 12) {
    test::record_near("3", "bodies and muscles, order of reactions", orders.reaction, 2.0, slack);
  }
  if (model.manifold->n_c() > 0) {
    test::record_near("3", "closed loops, order of multipliers", orders.multipliers, 2.0, slack);
  }
  std::cout << "orders: q " << orders.q << ", p " << orders.momentum << ", reaction " << orders.reaction
            << ", multipliers " << orders.multipliers << '\n';
}

void expect_order_two(const test::RigidSystem& system, const RunSetup& setup) {
  const auto model = test::make_model(system);
  expect_order_two(*model, test::state_at_rest(*model), setup);
}

TEST(Order, IsTwoForThePendulum) { expect_order_two(test::pendulum(), {.dt = 10.0, .steps = 60}); }

TEST(Order, IsTwoForTheDoublePendulum) { expect_order_two(test::double_pendulum(), {.dt = 4.0, .steps = 100}); }

TEST(Order, IsTwoForTheHeavyTop) {
  const auto model = test::make_model(test::heavy_top(30.0 * test::degree));
  const State rest = test::state_at_rest(*model);
  expect_order_two(*model, test::state_at(*model, rest.x, Eigen::Vector3d(0.05, -0.02, 0.3)), {.dt = 0.4, .steps = 50});
}

TEST(Order, IsTwoForTheMuscleJoint) { expect_order_two(test::muscle_joint(3e4), {.dt = 1.0, .steps = 100}); }

TEST(Order, IsTwoForTheTrunk) { expect_order_two(test::trunk(test::odd_fields(3e4)), {.dt = 1.0, .steps = 100}); }

TEST(Order, IsTwoForTheMembrane) { expect_order_two(test::membrane(3e4, 0.01), {.dt = 0.01, .steps = 50}); }

TEST(Order, IsTwoForTheRoundActuator) { expect_order_two(test::round_actuator(3e4, 0.01), {.dt = 0.02, .steps = 100}); }

TEST(Order, IsTwoForTheFourBar) {
  expect_order_two(test::four_bar({}, test::earth_gravity), {.dt = 1.0, .steps = 100});
}

TEST(Order, IsTwoForTheSliderCrank) {
  expect_order_two(test::slider_crank(test::earth_gravity), {.dt = 1.0, .steps = 100});
}

TEST(Order, IsTwoForTheBennettLinkage) {
  // More than a turn: no two of its five loop rows are independent all the way.
  const auto model = test::make_model(test::bennett(1.0));
  const State start = test::state_at(*model, model->manifold->reference(), test::admissible_rates(*model, 0, 0.01));
  expect_order_two(*model, start, {.dt = 4.0, .steps = 175});
}

TEST(Order, StaysTwoUnderSmoothControls) {
  // The control of a step is the one at its middle (numerics 1.10).
  test::RigidSystem joint = test::muscle_joint(0.0);
  joint.controls[0].function =
      base::TimeFunction(base::Sine{.amplitude = 1.5e4, .frequency = 0.02, .phase = 0.3, .offset = 2e4});
  expect_order_two(joint, {.dt = 1.0, .steps = 100});
  test::RigidSystem film = test::membrane(0.0, 0.01);
  film.controls[0].function =
      base::TimeFunction(base::Sine{.amplitude = 1e4, .frequency = 1.0, .phase = 0.3, .offset = 2e4});
  expect_order_two(film, {.dt = 0.01, .steps = 100});
}

TEST(Order, StaysTwoUnderControlsThatJumpAtNodes) {
  test::RigidSystem joint = test::muscle_joint(0.0);
  joint.controls[0].function = base::TimeFunction(base::Samples{.times = {0.0, 20.0, 50.0}, .values = {1e4, 3e4, 2e4}});
  expect_order_two(joint, {.dt = 1.0, .steps = 75});
}

TEST(Order, IsTwoWithSpringsAndDampersInTheJoint) {
  test::RigidSystem system = test::pendulum();
  system.joint_forces.push_back({.joint = 0, .stiffness = 20.0, .rest = 0.2, .damping = 500.0});
  expect_order_two(system, {.dt = 8.0, .steps = 50});
}

TEST(Order, IsTwoWithSpringsAndDampersInAllJointsOfALoop) {
  // Those of the tree act on coordinates, that of the cut joint on the directors.
  test::RigidSystem system = test::four_bar({}, test::earth_gravity);
  for (int j = 0; j < 4; ++j) system.joint_forces.push_back({.joint = j, .stiffness = 5.0, .damping = 50.0});
  expect_order_two(system, {.dt = 1.0, .steps = 100});
}

}  // namespace
}  // namespace muldi::variational
