/// Conservative motions run back (numerics 5 no. 15).
#include <gtest/gtest.h>

#include <iostream>

#include "stress/energy_history.hpp"
#include "support/figure.hpp"
#include "support/linkages.hpp"
#include "support/systems.hpp"

namespace muldi {
namespace {

struct Return {
  double position = 0.0;  ///< largest distance from the start, mm
  double momentum = 0.0;  ///< relative
};

/// Runs 1e4 steps there, turns the momentum round, and 1e4 back.
Return there_and_back(const model::Model& model, const variational::State& start, double dt) {
  const test::RunSetup setup{.dt = dt, .steps = 10'000};
  double largest = start.p.norm();
  test::Run there = test::run(model, start, setup, [&](const variational::NodeRecord& node) {
    largest = std::max(largest, node.values.momentum.norm());
  });
  EXPECT_EQ(there.result.status, variational::Status::completed) << there.result.sentence;
  // p_N = pi + dt/2 F of the last interval; the same interval run back has -pi and +F at its begin.
  variational::State turned = there.state;
  turned.p = -turned.p;
  turned.increment = -turned.increment;
  turned.step = 0;
  turned.t = 0.0;
  Return result;
  const test::Run back = test::run(model, turned, setup, [&](const variational::NodeRecord& node) {
    if (node.step != setup.steps) return;
    result.position = (node.state.q - start.q).lpNorm<Eigen::Infinity>();
    result.momentum = (node.values.momentum + start.p).norm() / largest;
  });
  EXPECT_EQ(back.result.status, variational::Status::completed) << back.result.sentence;
  std::cout << "back to " << result.position << " mm, momentum " << result.momentum << '\n';
  return result;
}

void expect_return(const std::string& name, const test::RigidSystem& system, const Eigen::VectorXd& x, double dt) {
  const auto model = test::make_model(system);
  const variational::State start = test::state_at(*model, x, Eigen::VectorXd::Zero(model->manifold->n_v()));
  const Return result = there_and_back(*model, start, dt);
  test::record_figure("15", name + ", 1e4 steps there and back, positions (mm)", result.position, 1e-9);
  test::record_figure("15", name + ", 1e4 steps there and back, momenta, relative", result.momentum, 1e-9);
}

TEST(Reversal, BringsThePendulumBack) { expect_return("pendulum", test::pendulum(), Eigen::VectorXd::Zero(1), 10.0); }

TEST(Reversal, BringsALoopWhoseRowsTurnBack) {
  const test::RigidSystem system = test::quick_return(test::earth_gravity);
  expect_return("quick-return", system, test::make_model(system)->manifold->reference(), 1.0);
}

TEST(Reversal, BringsAClosedLoopBack) {
  const test::RigidSystem system = test::four_bar({}, test::earth_gravity);
  expect_return("four-bar", system, test::make_model(system)->manifold->reference(), 1.0);
}

TEST(Reversal, BringsTheDoublePendulumBackFromRegularMotion) {
  expect_return("double pendulum", test::double_pendulum(), Eigen::Vector2d(-70.0 * test::degree, 0.0), 5.0);
}

TEST(Reversal, BringsAPendulumWithAJointSpringAndADriveBack) {
  test::RigidSystem system = test::pendulum();
  system.joint_forces.push_back({.joint = 0, .stiffness = 20.0, .rest = 0.5, .constant = 3.0});
  expect_return("driven pendulum", system, Eigen::VectorXd::Zero(1), 10.0);
}

TEST(Reversal, BringsTheUndampedMuscleJointBack) {
  expect_return("muscle joint", test::undamped(test::muscle_joint(3e4)), Eigen::VectorXd::Zero(1), 2.0);
}

TEST(Reversal, DoesNotBringADampedMotionBack) {
  test::RigidSystem system = test::pendulum();
  system.joint_forces.push_back({.joint = 0, .damping = 20.0});
  const auto model = test::make_model(system);
  test::record_at_least("15", "damped pendulum, distance from the start after the way back (mm)",
                        there_and_back(*model, test::state_at_rest(*model), 1.0).position, 1.0);
}

}  // namespace
}  // namespace muldi
