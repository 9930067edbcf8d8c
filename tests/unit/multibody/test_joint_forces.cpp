/// Springs, dampers, drives and stops on joint coordinates.
#include <gtest/gtest.h>

#include "multibody/registry.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi::multibody {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// The law of one force, whatever its joint.
JointForce law(const test::CoordinateForce& of) {
  return {.part = "joints/j",
          .stiffness = of.stiffness,
          .rest = of.rest,
          .damping = of.damping,
          .stops = of.stops,
          .control = of.control,
          .control_factor = of.control_factor,
          .constant = of.constant};
}

TEST(JointForce, AddsSpringDamperAndDrive) {
  const JointForce force =
      law({.stiffness = 2.0, .rest = 0.5, .damping = 3.0, .control = 0, .control_factor = 4.0, .constant = 1.0});
  const std::array<double, 1> u{0.25};
  const JointForce::Response r = force.respond({1.5, 0.1}, u);
  EXPECT_NEAR(r.force, -2.0 - 0.3 + 1.0 + 1.0, 1e-15);
  EXPECT_EQ(r.by_position, -2.0);
  EXPECT_EQ(r.by_rate, -3.0);
  EXPECT_NEAR(r.damping_force, -0.3, 1e-16);
  EXPECT_EQ(r.drive, 2.0);
  EXPECT_EQ(force.potential(1.5), 1.0);
}

TEST(JointForce, StopsPushBackOutsideOnly) {
  const JointForce force = law({.stops = {.lower = -1.0, .upper = 2.0, .stiffness = 10.0, .damping = 0.5}});
  EXPECT_EQ(force.respond({0.0, 5.0}, {}).force, 0.0);
  EXPECT_EQ(force.potential(2.0), 0.0);
  EXPECT_NEAR(force.respond({2.1, 0.0}, {}).force, -1.0, 1e-14);
  EXPECT_NEAR(force.respond({-1.2, 0.0}, {}).force, 2.0, 1e-14);
  EXPECT_NEAR(force.respond({2.1, 0.2}, {}).force, -1.0 - 0.1, 1e-14);
  EXPECT_NEAR(force.potential(2.1), 0.05, 1e-15);
  EXPECT_NEAR(force.potential(-1.2), 0.2, 1e-15);
}

TEST(JointForce, WithoutStopsHasAFinitePotentialEverywhere) { EXPECT_EQ(law({.stiffness = 1.0}).potential(1e6), 5e11); }

TEST(JointForces, SpringForceIsMinusTheSlopeOfTheEnergyOverManyTurns) {
  test::RigidSystem system = test::pendulum(0.0);
  system.joint_forces.push_back({.stiffness = 2.0, .rest = 0.5});
  const auto model = test::make_model(system);
  for (const double angle : {-20.0, -3.2, 0.4, 3.1, 3.2, 12.0}) {
    const VectorXd x = VectorXd::Constant(1, angle);
    const VectorXd q = test::configuration_at(*model->manifold, x);
    const VectorXd v = VectorXd::Zero(12);
    std::vector<model::Energy> energy(model->parts().size());
    model->energies({.x = {x.data(), 1}, .q = q, .v = v, .u = {}}, energy);
    EXPECT_NEAR(energy[1].elastic, (angle - 0.5) * (angle - 0.5), 1e-11);
    model::IntervalForces out{VectorXd(12), VectorXd(12)};
    out.on_rates = VectorXd(1);
    model->forces({.q0 = q, .q1 = q, .q = q, .v = v, .u = {}, .x0 = {x.data(), 1}, .x1 = {x.data(), 1}}, out);
    EXPECT_NEAR(out.on_rates[0], -2.0 * (angle - 0.5), 1e-12);
    EXPECT_EQ(out.force.norm(), 0.0);
  }
}

TEST(JointForces, ShareTheirPartOfOneJoint) {
  test::RigidSystem system = test::double_pendulum();
  system.joint_forces = {{.joint = 1, .stiffness = 1.0}, {.joint = 0, .damping = 1.0}, {.joint = 1, .constant = 1.0}};
  const auto model = test::make_model(system);
  EXPECT_EQ(model->parts(),
            (std::vector<std::string>{"bodies/body0", "bodies/body1", "joints/joint1", "joints/joint0"}));
}

TEST(JointForces, DoTheWorkOfTheAngleThatAnIntervalTurns) {
  test::RigidSystem system = test::pendulum(0.0);
  system.joint_forces.push_back({.damping = 3.0, .constant = 5.0});
  const auto model = test::make_model(system);
  const VectorXd x0 = VectorXd::Constant(1, 0.3);
  const VectorXd x1 = VectorXd::Constant(1, 0.32);
  const VectorXd q0 = test::configuration_at(*model->manifold, x0);
  const VectorXd q1 = test::configuration_at(*model->manifold, x1);
  const double dt = 0.1;
  const VectorXd v = (q1 - q0) / dt;
  const VectorXd q = 0.5 * (q0 + q1);
  const model::IntervalWork work =
      model->work({.q0 = q0, .q1 = q1, .q = q, .v = v, .u = {}, .dt = dt, .x0 = {x0.data(), 1}, .x1 = {x1.data(), 1}});
  EXPECT_NEAR(work.dissipated, dt * 3.0 * 0.2 * 0.2, 1e-14);
  EXPECT_NEAR(work.external, 5.0 * 0.02, 1e-14);
}

TEST(JointForces, OfAConstantDriveDoTheWorkOfTorqueTimesAngle) {
  test::RigidSystem system;
  system.add_body(10.0, Vector3d(100.0, 100.0, 300.0), {});
  system.connect(Revolute::pattern, {ground, 0}, Vector3d::Zero());
  system.joint_forces.push_back({.constant = 0.6});
  const auto model = test::make_model(system);
  const test::Run run = test::run(*model, test::state_at_rest(*model), {.dt = 0.5, .steps = 100});
  ASSERT_EQ(run.result.status, variational::Status::completed);
  EXPECT_NEAR(run.ledger.external, 0.6 * run.state.x[0], 1e-12);
  // torque t^2/(2 I); the rule is of second order in the angle of a step, 0.05 at the end.
  EXPECT_NEAR(run.state.x[0], 0.5 * 0.6 / 300.0 * 2500.0, 1e-3);
}

TEST(JointForces, DoNotAppearInReactions) {
  // A horizontal beam on a universal joint, held up by springs: the reaction is its weight alone, without a moment.
  test::RigidSystem system;
  system.gravity = Vector3d(0.0, 0.0, -0.01);
  system.add_body(10.0, Vector3d(100.0, 4000.0, 4000.0), {.position = Vector3d(20.0, 10.0, 0.0)});
  system.connect(Universal::pattern, {ground, 0}, Vector3d::Zero());
  // At the scene pose: moments of the weight about x and y, 10 mN on arms of 10 and 20 mm.
  system.joint_forces = {{.joint = 0, .motion = 0, .constant = 1.0}, {.joint = 0, .motion = 1, .constant = -2.0}};
  const auto model = test::make_model(system);
  const test::Run run =
      test::run(*model, test::state_at_rest(*model), {.dt = 1.0, .steps = 5}, [&](const variational::NodeRecord& node) {
        Eigen::Matrix<double, 6, 1> wrench = Eigen::Matrix<double, 6, 1>::Zero();
        for (int k = 0; k < 4; ++k) {
          const Vector3d f = node.constraint_force.segment<3>(3 * k);
          const Vector3d at = node.state.q.segment<3>(3 * k);
          if (k == 0) wrench.head<3>() = f;
          wrench.tail<3>() += at.cross(f);
        }
        EXPECT_LT((wrench.head<3>() - Vector3d(0.0, 0.0, 0.1)).norm(), 1e-12);
        EXPECT_LT(wrench.tail<3>().norm(), 1e-11);
      });
  ASSERT_EQ(run.result.status, variational::Status::completed);
  EXPECT_LT(run.state.x.norm(), 1e-13);
}

TEST(JointForces, HoldAPrismaticJointAtItsSpringLength) {
  // A slide under its weight settles at rest + m g/k: damped until it stands.
  test::RigidSystem system;
  system.gravity = Vector3d(0.0, 0.0, -0.01);
  system.add_body(10.0, Vector3d(100.0, 100.0, 100.0), {.position = Vector3d(1.0, 2.0, 3.0)});
  system.connect(Prismatic::pattern, {ground, 0}, Vector3d(5.0, 0.0, 0.0));
  system.joint_forces.push_back({.stiffness = 0.02, .rest = 1.0, .damping = 0.9});
  const auto model = test::make_model(system);
  const test::Run run = test::run(*model, test::state_at_rest(*model), {.dt = 2.0, .steps = 2000});
  ASSERT_EQ(run.result.status, variational::Status::completed);
  EXPECT_NEAR(run.state.x[0], 1.0 - 10.0 * 0.01 / 0.02, 1e-9);
}

}  // namespace
}  // namespace muldi::multibody
