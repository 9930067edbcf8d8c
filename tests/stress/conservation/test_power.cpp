/// Work, dissipation and energy of a joint with spring, damper and drive (numerics 5 no. 24).
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
  return (total - ledger.initial_total + ledger.dissipated - ledger.external) /
         (ledger.dissipated + std::abs(ledger.external));
}

TEST(Power, OfADrivenAndDampedPendulumBalances) {
  test::RigidSystem system = test::pendulum();
  system.controls = {{.name = "drive", .unit = base::dimension::torque, .function = 8.0}};
  system.joint_forces.push_back({.joint = 0, .stiffness = 10.0, .damping = 300.0, .control = 0, .constant = 2.0});
  const auto model = test::make_model(system);
  const double coarse = left_over(*model, 8.0, 60);
  const double fine = left_over(*model, 4.0, 120);
  test::record_figure("24", "driven and damped pendulum, rest of the balance over the turnover", std::abs(coarse),
                      1e-2);
  test::record_near("24", "driven and damped pendulum, ratio of the rest on halving", coarse / fine, 4.0, 0.2);
}

}  // namespace
}  // namespace muldi
