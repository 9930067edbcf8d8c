/// Guesses: resting, simulated, refined.
#include <gtest/gtest.h>

#include "support/control_problems.hpp"
#include "support/trajectory.hpp"

namespace muldi::control {
namespace {

using test::ControlCase;

TEST(Guess, RestingHoldsTheInitialPose) {
  ControlCase at = test::joint_case(4, 10.0);
  at.problem.initial.x.reset();
  at.problem.initial.coordinates.push_back({.name = "joints.hinge", .rate = 0, .value = 0.2});
  const Trajectory guess = resting_guess(at.problem, 10.0);
  ASSERT_EQ(guess.x.size(), 5u);
  ASSERT_EQ(guess.u.size(), 4u);
  EXPECT_EQ(guess.x[4][0], 0.2);
  EXPECT_EQ(guess.u[3][1], 0.0);
}

TEST(Guess, SimulationIsTheForwardRun) {
  const ControlCase at = test::joint_case(4, 10.0);
  const Trajectory guess = simulate_guess(at.problem, 10.0, std::vector<std::vector<double>>(4, {3e4, 0.0}));
  auto model = test::make_model(test::muscle_joint(3e4));
  const test::Run run = test::run(*model, test::state_at_rest(*model), {.dt = 10.0, .steps = 4});
  EXPECT_NEAR(guess.x[4][0], run.state.x[0], 1e-12);
}

TEST(Guess, RefinementInterpolatesPosesAndHoldsControls) {
  const ControlCase coarse = test::joint_case(2, 10.0);
  const ControlCase fine = test::joint_case(4, 5.0);
  Trajectory guess = resting_guess(coarse.problem, 10.0);
  guess.x[1][0] = 0.2;
  guess.x[2][0] = 0.6;
  guess.u = {{1.0, 2.0}, {3.0, 4.0}};
  const Trajectory refined = refined_guess(fine.problem, guess);
  ASSERT_EQ(refined.x.size(), 5u);
  EXPECT_NEAR(refined.x[1][0], 0.1, 1e-15);
  EXPECT_NEAR(refined.x[3][0], 0.4, 1e-15);
  EXPECT_EQ(refined.u[1], guess.u[0]);
  EXPECT_EQ(refined.u[2], guess.u[1]);
  EXPECT_EQ(refined.step, 5.0);
}

}  // namespace
}  // namespace muldi::control
