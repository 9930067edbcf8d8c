/// Steps from small to far too large: resolved, warned of, refused (numerics 1.8, 5 no. 23).
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "support/figure.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi {
namespace {

using Eigen::VectorXd;
using variational::Status;

struct Outcome {
  variational::LoopResult result;
  bool warned = false;
  double last_angle = 0.0;
};

Outcome spin(double rate_dt) {
  const auto model = test::make_model(test::pendulum(0.0));
  variational::State state = test::state_at(*model, VectorXd::Zero(1), VectorXd::Constant(1, rate_dt));
  variational::TimeLoop loop(*model, {.dt = 1.0, .steps = 200});
  variational::Ledger ledger;
  variational::StepReport last;
  Outcome outcome;
  outcome.result =
      loop.run(state, ledger, last,
               {.record = {}, .warn = [&](const variational::StepReport&, double) { outcome.warned = true; }});
  outcome.last_angle = state.x[0];
  return outcome;
}

TEST(StepSize, IsWarnedOfAboveHalfARadian) {
  // A momentum step turns a spinning body by asin(w dt): no solution from 1 on.
  for (const double rate_dt : {0.1, 0.2, 0.3, 0.4, 0.47, 0.49, 0.6, 0.8, 0.95, 0.99}) {
    const Outcome outcome = spin(rate_dt);
    EXPECT_EQ(outcome.result.status, Status::completed) << rate_dt << ": " << outcome.result.sentence;
    EXPECT_EQ(outcome.warned, std::asin(rate_dt) > 0.5) << rate_dt;
    EXPECT_NEAR(outcome.last_angle, 200.0 * std::asin(rate_dt), 1e-7) << rate_dt;
  }
}

TEST(StepSize, IsRefusedWhereNoStepExists) {
  for (const double rate_dt : {1.01, 1.2, 1.5, 2.0, 2.5, 3.0}) {
    const Outcome outcome = spin(rate_dt);
    EXPECT_TRUE(outcome.result.status == Status::no_convergence || outcome.result.status == Status::step_too_large)
        << rate_dt;
    EXPECT_FALSE(outcome.result.sentence.empty());
    EXPECT_EQ(outcome.result.statistics.steps, 0) << rate_dt;
    EXPECT_EQ(outcome.last_angle, 0.0) << "the state stays at the last good node";
  }
}

TEST(StepSize, LeavesOscillationsBelowTheirFrequencyInTheKnownWay) {
  // Small oscillation of the membrane about its equilibrium (numerics 3.8: 5.86779812517 rad/ms): midpoint has the
  // frequency (2/dt) atan(w dt/2), below pi/dt for any step, and the amplitude of the start.
  constexpr double omega = 5.86779812517;
  const auto model = test::make_model(test::membrane(3e4, 0.0));
  const double rest_length = 0.953727609917;  // numerics 3.1
  for (const double angle : {0.1, 0.3, 1.0, 2.0, 3.0, std::numbers::pi}) {
    const double dt = angle / omega;
    const double amplitude = 1e-6;
    const variational::State start =
        test::state_at(*model, VectorXd::Constant(1, rest_length + amplitude), VectorXd::Zero(1));
    double largest_error = 0.0;
    const double turn = 2.0 * std::atan(0.5 * angle);
    const test::Run done = test::run(*model, start, {.dt = dt, .steps = 500}, [&](const variational::NodeRecord& node) {
      const double expected = amplitude * std::cos(turn * static_cast<double>(node.step));
      largest_error = std::max(largest_error, std::abs(node.state.q[0] - rest_length - expected));
    });
    ASSERT_EQ(done.result.status, Status::completed);
    std::cout << "w dt " << angle << ": " << largest_error / amplitude << " of the amplitude\n";
    test::record_figure("23", "membrane at omega dt " + test::short_number(angle) + ", error of its amplitude",
                        largest_error / amplitude, 1e-3);
  }
}

TEST(StepSize, DoesNotLoseTurnsOfAWoundUpJoint) {
  // A torsion spring swings the body over 6.4 turns: J th'' = -k th with amplitude 20 rad.
  test::RigidSystem system = test::pendulum(0.0);
  const double inertia = 3.17e5 + 40.0 * 46.0 * 46.0;
  const double omega = 0.002;
  system.joint_forces.push_back({.joint = 0, .stiffness = inertia * omega * omega});
  const auto model = test::make_model(system);
  const variational::State start = test::state_at(*model, VectorXd::Constant(1, 20.0), VectorXd::Zero(1));
  const auto error_at_end = [&](double dt, long steps) {
    const test::Run done = test::run(*model, start, {.dt = dt, .steps = steps});
    EXPECT_EQ(done.result.status, Status::completed) << done.result.sentence;
    return done.state.x[0] - 20.0 * std::cos(omega * done.state.t);
  };
  const double coarse = error_at_end(2.0, 10'000);
  const double fine = error_at_end(1.0, 20'000);
  std::cout << "error " << coarse << ", ratio " << coarse / fine << '\n';
  test::record_near("21", "6.4 turns of a wound-up joint, error over that of half the step", coarse / fine, 4.0, 0.2);
  EXPECT_LT(std::abs(test::extrapolated(coarse, fine)), 2e-3) << "a turn lost would be 6.3";
}

}  // namespace
}  // namespace muldi
