/// What is recorded of bodies and joints: coordinates, velocities, reactions.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "multibody/multibody_observables.hpp"
#include "multibody/registry.hpp"
#include "support/linkages.hpp"
#include "support/random_tree.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi::multibody {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using Row = std::map<std::string, VectorXd>;

/// Values of all joint series at node `step` of a run.
Row joints_at(const model::Model& model, const variational::State& state, const test::RunSetup& setup, long step) {
  JointRecords records(test::manifold_of(model));
  Row row;
  std::vector<model::Observable> all = records.observables();
  for (const auto& body : body_observables("b", 0)) all.push_back(body);
  for (const auto& observable : all)
    row[observable.path] = VectorXd::Zero(static_cast<Eigen::Index>(observable.size()));
  const test::Run run = test::run(model, state, setup, [&](const variational::NodeRecord& node) {
    if (node.step > step) return;
    for (const auto& observable : all) {
      VectorXd& values = row[observable.path];
      observable.evaluate(variational::view_of(node), {values.data(), static_cast<std::size_t>(values.size())});
    }
  });
  EXPECT_EQ(run.result.status, variational::Status::completed) << run.result.sentence;
  return row;
}

const auto vector6 = [](double fx, double fy, double fz, double mx, double my, double mz) {
  return (VectorXd(6) << fx, fy, fz, mx, my, mz).finished();
};

TEST(JointRecords, ReactionOfAFixedBodyIsItsWeightAndItsMoment) {
  for (const bool reversed : {false, true}) {
    test::RigidSystem system;
    system.gravity = Vector3d(0.0, -0.01, 0.0);
    system.add_body(40.0, Vector3d(1e4, 1e4, 1e4), {.position = Vector3d(46.0, 0.0, 0.0)});
    system.connect(Fixed::pattern, reversed ? std::pair(0, ground) : std::pair(ground, 0), Vector3d::Zero());
    const auto model = test::make_model(system);
    const Row row = joints_at(*model, test::state_at_rest(*model), {.dt = 1.0, .steps = 5}, 3);
    // On `to` about its connector: the body is held up, ground is pulled down.
    const double sign = reversed ? -1.0 : 1.0;
    EXPECT_LT((row.at("joints/joint0/reaction") - sign * vector6(0.0, 0.4, 0.0, 0.0, 0.0, 0.4 * 46.0)).norm(), 1e-12);
    EXPECT_EQ(row.count("joints/joint0/coordinate"), 0u) << "a fixed joint has none";
  }
}

TEST(JointRecords, ReactionOfAPendulumAtItsReleaseIsTheClosedForm) {
  // Released horizontally: alpha = -m g l/J_O, so that the joint carries m (g - |alpha| l), here to the order dt^2.
  const auto model = test::make_model(test::pendulum());
  const Row row = joints_at(*model, test::state_at_rest(*model), {.dt = 0.01, .steps = 2}, 0);
  const double alpha = 40.0 * test::earth_gravity * 46.0 / 401640.0;
  const VectorXd reaction = row.at("joints/joint0/reaction");
  EXPECT_NEAR(reaction[1], 40.0 * (test::earth_gravity - alpha * 46.0), 1e-8);
  EXPECT_LT(reaction.tail<3>().norm(), 1e-8) << "a revolute joint in the plane carries no moment";
  EXPECT_NEAR(row.at("joints/joint0/velocity")[0], 0.0, 1e-15);
}

TEST(JointRecords, ReactionsOfAHangingChainAreTheWeightsBelow) {
  // Hanging at rest; half of the joints run from the lower to the upper body.
  test::RigidSystem system;
  system.gravity = Vector3d(0.0, 0.0, -0.01);
  for (int i = 0; i < 4; ++i) {
    system.add_body(10.0 + i, Vector3d(1e3, 1e3, 1e3), {.position = Vector3d(0.0, 0.0, -10.0 - 20.0 * i)});
    const std::pair<int, int> ends = i % 2 == 0 ? std::pair(i - 1, i) : std::pair(i, i - 1);
    system.connect(Spherical::pattern, ends, Vector3d(0.0, 0.0, -20.0 * i));
  }
  const auto model = test::make_model(system);
  const Row row = joints_at(*model, test::state_at_rest(*model), {.dt = 1.0, .steps = 10}, 5);
  double below = 0.0;
  for (int i = 3; i >= 0; --i) {
    below += 0.01 * (10.0 + i);
    const double up = i % 2 == 0 ? below : -below;
    const VectorXd reaction = row.at("joints/joint" + std::to_string(i) + "/reaction");
    EXPECT_LT((reaction - vector6(0.0, 0.0, up, 0.0, 0.0, 0.0)).norm(), 1e-11) << i;
  }
}

TEST(JointRecords, CutJointsCarryTheirShare) {
  // A coupler hangs on two equal rods, straight down: every joint carries its half.
  test::RigidSystem system;
  system.gravity = Vector3d(0.0, -0.01, 0.0);
  const Vector3d inertia(1e3, 1e3, 1e3);
  const int left = system.add_body(10.0, inertia, {.position = Vector3d(0.0, -20.0, 0.0)});
  const int coupler = system.add_body(30.0, inertia, {.position = Vector3d(50.0, -40.0, 0.0)});
  const int right = system.add_body(10.0, inertia, {.position = Vector3d(100.0, -20.0, 0.0)});
  system.connect(Revolute::pattern, {ground, left}, Vector3d(0.0, 0.0, 0.0));
  system.connect(Revolute::pattern, {left, coupler}, Vector3d(0.0, -40.0, 0.0));
  system.connect(Revolute::pattern, {coupler, right}, Vector3d(100.0, -40.0, 0.0));
  system.connect(Revolute::pattern, {right, ground}, Vector3d(100.0, 0.0, 0.0));
  const auto model = test::make_model(system);
  const Row row = joints_at(*model, test::state_at_rest(*model), {.dt = 1.0, .steps = 10}, 5);
  const auto up = [&](int j) { return row.at("joints/joint" + std::to_string(j) + "/reaction")[1]; };
  EXPECT_NEAR(up(0), 0.25, 1e-11);
  EXPECT_NEAR(up(1), 0.15, 1e-11);
  EXPECT_NEAR(up(2), -0.15, 1e-11) << "on the rod";
  EXPECT_NEAR(up(3), -0.25, 1e-11) << "on ground";
  for (int j = 0; j < 4; ++j) EXPECT_NEAR(row.at("joints/joint" + std::to_string(j) + "/reaction")[0], 0.0, 1e-11);
}

TEST(JointRecords, CutJointsHaveCoordinatesAndVelocities) {
  // A four-bar that turns many times: the sum of the joint angles around the loop stays 0, and the same of the rates.
  const auto model = test::make_model(test::four_bar({}, 0.0));
  const VectorXd w = test::admissible_rates(*model, 0, 0.05);
  const Row row =
      joints_at(*model, test::state_at(*model, model->manifold->reference(), w), {.dt = 0.5, .steps = 1000}, 999);
  double angle = 0.0;
  double rate = 0.0;
  for (int j = 0; j < 4; ++j) {
    angle += row.at("joints/joint" + std::to_string(j) + "/coordinate")[0];
    rate += row.at("joints/joint" + std::to_string(j) + "/velocity")[0];
  }
  EXPECT_GT(std::abs(row.at("joints/joint0/coordinate")[0]), 10.0) << "it turns";
  EXPECT_NEAR(angle, 0.0, 1e-10);
  EXPECT_NEAR(rate, 0.0, 1e-12);
}

TEST(JointRecords, BodiesReportOrientationByRowsAndAngularVelocity) {
  test::RigidSystem system;
  const Eigen::Matrix3d R = (Eigen::Matrix3d() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished();
  system.add_body(1.0, Vector3d::Ones(), {.position = Vector3d(1.0, 2.0, 3.0), .orientation = R});
  const auto model = test::make_model(system);
  const VectorXd w{{0.1, 0.2, 0.3, 0.01, 0.02, 0.03}};
  const Row row =
      joints_at(*model, test::state_at(*model, model->manifold->reference(), w), {.dt = 1.0, .steps = 1}, 0);
  EXPECT_LT((row.at("bodies/b/position") - Vector3d(1.0, 2.0, 3.0)).norm(), 1e-15);
  EXPECT_LT((row.at("bodies/b/orientation") - (VectorXd(9) << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished()).norm(), 1e-15);
  EXPECT_LT((row.at("bodies/b/velocity") - w.head(3)).norm(), 1e-14);
  EXPECT_LT((row.at("bodies/b/angular_velocity") - w.tail(3)).norm(), 1e-14);
}

TEST(JointRecords, NameTheirSeriesByJoint) {
  test::RigidSystem system;
  system.add_body(1.0, Vector3d::Ones(), {});
  system.connect(Cylindrical::pattern, {ground, 0}, Vector3d::Zero());
  system.joints[0].name = "slot";
  const auto model = test::make_model(system);
  JointRecords records(test::manifold_of(*model));
  const auto all = records.observables();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].path, "joints/slot/coordinate");
  EXPECT_EQ(all[0].shape, std::vector<std::size_t>{2});
  EXPECT_EQ(all[0].doc, "joint coordinates, zero in the scene pose (lengths, then angles)");
  EXPECT_EQ(all[1].path, "joints/slot/velocity");
  EXPECT_EQ(all[2].path, "joints/slot/reaction");
  EXPECT_EQ(all[2].shape, std::vector<std::size_t>{6});
}

}  // namespace
}  // namespace muldi::multibody
