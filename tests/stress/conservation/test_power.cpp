/// Work, dissipation and energy of joints with springs, dampers and drives, muscles and loads (numerics 5 no. 24).
#include <gtest/gtest.h>

#include <cmath>

#include "support/figure.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi {
namespace {

/// What is left of the change of energy less work plus dissipation, over all that went through.
double left_over(const model::Model& model, double dt, long steps) {
  double total = 0.0;
  const test::Run done = test::run(
      model, test::state_at_rest(model), {.dt = dt, .steps = steps},
      [&](const variational::NodeRecord& node) { total = node.values.total.kinetic + node.values.total.potential(); });
  EXPECT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
  const variational::Ledger& ledger = done.ledger;
  return (total - ledger.initial_total + ledger.dissipated - ledger.external - ledger.source) /
         (ledger.dissipated + std::abs(ledger.external) + std::abs(ledger.source));
}

void expect_balance(const std::string& name, const test::RigidSystem& system, double dt, long steps) {
  const auto model = test::make_model(system);
  const double coarse = left_over(*model, dt, steps);
  const double fine = left_over(*model, 0.5 * dt, 2 * steps);
  test::record_figure("24", name + ", rest of the balance over the turnover", std::abs(coarse), 1e-2);
  test::record_near("24", name + ", ratio of the rest on halving", coarse / fine, 4.0, 0.2);
}

TEST(Power, OfADrivenAndDampedPendulumBalances) {
  test::RigidSystem system = test::pendulum();
  system.controls = {{.name = "drive", .unit = base::dimension::torque, .function = 8.0}};
  system.joint_forces.push_back({.joint = 0, .stiffness = 10.0, .damping = 300.0, .control = 0, .constant = 2.0});
  expect_balance("driven and damped pendulum", system, 8.0, 60);
}

TEST(Power, OfAMuscleWithViscosityBalances) {
  expect_balance("muscle joint with viscosity", test::muscle_joint(3e4), 1.0, 100);
}

TEST(Power, OfALoadedBodyBalances) {
  // A force that turns with the body does the work of more than its potential.
  test::RigidSystem system = test::pendulum();
  system.loads = {{.name = "push",
                   .frame = multibody::Load::Frame::body,
                   .body = 0,
                   .point = {30.0, 0.0, 0.0},
                   .direction = {0.0, 0.2, 0.0}},
                  {.name = "turn", .kind = multibody::Load::Kind::torque, .body = 0, .direction = {0.0, 0.0, 5.0}}};
  expect_balance("loaded pendulum", system, 8.0, 60);
}

}  // namespace
}  // namespace muldi
