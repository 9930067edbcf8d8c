/// No memory is asked for in the steps (issue: no allocation in the step).
#include <gtest/gtest.h>

#include <vector>

#include "multibody/registry.hpp"
#include "support/allocation_count.hpp"
#include "support/linkages.hpp"
#include "support/random_tree.hpp"
#include "support/systems.hpp"
#include "variational/time_loop.hpp"

namespace muldi::variational {
namespace {

TEST(Allocation, IsCounted) {
  const long before = test::n_allocations();
  std::vector<double> memory(1000);
  double* volatile seen = memory.data();  // or the compiler leaves the memory out
  EXPECT_NE(seen, nullptr);
  EXPECT_GE(test::n_allocations() - before, test::counts_allocations() ? 1 : 0);
}

/// Requests during 20 steps and node evaluations after the first two.
long allocations(const test::RigidSystem& system, const std::string& linear, double dt) {
  const auto model = test::make_model(system);
  Stepper stepper(*model, dt, {.linear = linear});
  EXPECT_EQ(stepper.solver_name(), linear);
  NodeEvaluator nodes(*model, linear);
  NodeValues values;
  State state = test::state_at_rest(*model);
  std::vector<double> u(model->controls.size());
  long before = 0;
  for (int n = 0; n < 22; ++n) {
    if (n == 2) before = test::n_allocations();
    model->evaluate_controls(dt * (n + 0.5), u);
    EXPECT_TRUE(nodes.evaluate(state, u, u, values));
    const StepReport report = stepper.advance(state, u);
    EXPECT_EQ(report.status, Status::running);
  }
  return test::n_allocations() - before;
}

/// 30 bodies with joint springs and loads.
test::RigidSystem busy_chain() {
  test::RigidSystem system = test::revolute_chain(30);
  for (int j = 0; j < 30; ++j) {
    system.joint_forces.push_back(
        {.joint = j, .stiffness = 10.0, .damping = 1.0, .stops = {.lower = -1.0, .upper = 1.0}});
  }
  system.loads.push_back({.name = "l", .body = 7, .direction = Eigen::Vector3d::UnitY()});
  return system;
}

test::RigidSystem with_far_springs(test::RigidSystem system) {
  for (int n = 0; n < 3; ++n) {
    system.springs.push_back({.name = "far",
                              .element = {.stiffness = 1e-3},
                              .a1 = {n, Eigen::Vector3d(1.0, 2.0, 3.0)},
                              .a2 = {system.n_bodies() - 1 - n, Eigen::Vector3d::Zero()}});
  }
  return system;
}

TEST(Allocation, NoneInAStepOfATree) {
  EXPECT_EQ(allocations(busy_chain(), "tree", 1.0), 0);
  EXPECT_EQ(allocations(test::trunk(test::odd_fields(3e4)), "tree", 1.0), 0);
  EXPECT_EQ(allocations(test::muscle_joint(3e4), "tree", 1.0), 0);
  EXPECT_EQ(allocations(test::membrane(3e4, 0.01), "tree", 0.01), 0);
}

TEST(Allocation, NoneInAStepOfADenseSystem) {
  EXPECT_EQ(allocations(with_far_springs(busy_chain()), "dense", 1.0), 0);
  EXPECT_EQ(allocations(test::heavy_top(0.5), "dense", 1.0), 0);
  // Above Eigen's 128 kB for products on the stack.
  EXPECT_EQ(allocations(test::revolute_chain(150), "dense", 1.0), 0);
}

TEST(Allocation, NoneInAStepOfABorderedSystem) {
  EXPECT_EQ(allocations(with_far_springs(busy_chain()), "bordered", 1.0), 0);
}

TEST(Allocation, NoneInAStepWithLoops) {
  EXPECT_EQ(allocations(test::four_bar({}, test::earth_gravity), "dense", 1.0), 0);
  EXPECT_EQ(allocations(test::four_bar({}, test::earth_gravity), "bordered", 1.0), 0);
}

TEST(Allocation, RunsOfTheTimeLoopAskForTheSameWhateverTheirLength) {
  const auto model = test::make_model(test::muscle_joint(3e4));
  const auto of_run = [&](long steps) {
    const long before = test::n_allocations();
    TimeLoop loop(*model, {.dt = 1.0, .steps = steps});
    State state = test::state_at_rest(*model);
    Ledger ledger;
    StepReport last;
    const LoopResult result = loop.run(state, ledger, last, {});
    EXPECT_EQ(result.status, Status::completed);
    return test::n_allocations() - before;
  };
  EXPECT_EQ(of_run(10), of_run(200));
}

}  // namespace
}  // namespace muldi::variational
