/// Gradient, Jacobian and Hessian of transcribed problems against differences, and their patterns.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "control/transcription.hpp"
#include "multibody/joint_coordinate.hpp"
#include "support/control_problems.hpp"
#include "support/linkages.hpp"

namespace muldi::control {
namespace {

using Eigen::Vector3d;
using test::ControlCase;

void expect_clean(const Problem& problem, const std::vector<WeightedObjective>& objectives, const Trajectory& guess) {
  const std::vector<Fault> faults = find_faults(problem, guess);
  for (const Fault& fault : faults) ADD_FAILURE() << fault.where << ": " << fault.why;
  if (!faults.empty()) return;
  for (const DerivativeCheck& line : check_derivatives(problem, objectives, guess)) {
    EXPECT_LT(line.error, 1e-7) << line.what << ", slope " << line.slope;
  }
}

/// Every objective at once.
std::vector<WeightedObjective> all_objectives(const ControlCase& at, const model::LinearPoint& point) {
  const std::size_t n = at.problem.controls.size();
  return {{0.7, Effort{.factors = std::vector<double>(n, 1.3)}},
          {0.5, Rate{}},
          {0.1, FinalTime{}},
          {0.2, Tracking{.coordinates = {{.rate = 0, .wanted = 0.3}},
                         .points = {{.point = point, .wanted = {1.0, std::nullopt, 2.0}}}}},
          {0.3, Terminal{.coordinates = {{.rate = 0, .wanted = 0.4}},
                         .points = {{.point = point, .wanted = {std::nullopt, 1.0, std::nullopt}}}}},
          {0.4, KineticEnergy{}},
          {0.6, PeakField{.factors = std::vector<double>(n, 0.8)}}};
}

TEST(Nlp, DerivativesOfTheMuscleJoint) {
  ControlCase at = test::joint_case(4, 10.0);
  expect_clean(at.problem, test::effort_of_fields(2), resting_guess(at.problem, 10.0));
}

TEST(Nlp, DerivativesOfTheTrunk) {
  ControlCase at = test::trunk_case(3, 25.0);
  expect_clean(at.problem, test::effort_of_fields(12), resting_guess(at.problem, 25.0));
}

TEST(Nlp, DerivativesOfABallDrivenByLoads) {
  ControlCase at(test::driven_free_body());
  at.set_horizon(3, 2.0);
  at.seek_plain(1.0);
  at.start_at_rest();
  at.problem.final.momentum = {.kind = MomentumCondition::Kind::momenta,
                               .values = Eigen::VectorXd::LinSpaced(6, -1.0, 1.0)};
  expect_clean(at.problem, all_objectives(at, multibody::body_point(0, Vector3d(0.1, 0.2, 0.3))),
               resting_guess(at.problem, 2.0));
}

TEST(Nlp, DerivativesOfFreeActuatorsAndOfConsistentInertia) {
  ControlCase actuator(test::round_actuator(0.0, 0.5));
  actuator.set_horizon(3, 0.1);
  actuator.seek_squares(4e4);
  actuator.start_at_rest();
  expect_clean(actuator.problem, test::effort_of_fields(1), resting_guess(actuator.problem, 0.1));

  test::RigidSystem system = test::muscle_joint(0.0);
  for (auto& muscle : system.muscles) muscle.element.inertia = muscles::Inertia::consistent;
  ControlCase joint(system);
  joint.set_horizon(3, 10.0);
  joint.seek_squares(5e4);
  joint.start_at_rest();
  joint.problem.controls[1].kind = ControlKind::plain;
  expect_clean(joint.problem, test::effort_of_fields(2), resting_guess(joint.problem, 10.0));
}

TEST(Nlp, DerivativesOfALongChain) {
  // More coordinates behind one spring than fit into small blocks.
  test::RigidSystem system = test::revolute_chain(15);
  system.springs.push_back({.name = "spring",
                            .element = {.stiffness = 0.5, .rest_length = 10.0, .damping = 0.2},
                            .a1 = {multibody::ground, Vector3d(1000.0, 300.0, 100.0)},
                            .a2 = {14, Vector3d(10.0, 20.0, 5.0)}});
  system.joint_forces.push_back({.joint = 3, .damping = 1.0, .control = 0});
  system.controls.push_back({.name = "torque", .unit = {}, .function = 0.0});
  ControlCase at(system);
  at.set_horizon(2, 1.0);
  at.seek_plain(1e3);
  at.start_at_rest();
  at.problem.final.momentum.kind = MomentumCondition::Kind::free;
  expect_clean(at.problem, test::feasibility(), resting_guess(at.problem, 1.0));
}

TEST(Nlp, DerivativesByTheStep) {
  ControlCase at = test::joint_case(4, 10.0);
  at.problem.horizon.longest_step = 20.0;
  expect_clean(at.problem, {{1.0, FinalTime{}}}, resting_guess(at.problem, 12.0));
  ControlCase body(test::driven_free_body());
  body.problem.horizon = {.n_steps = 3, .shortest_step = 1.0, .longest_step = 3.0};
  body.seek_plain(1.0);
  body.start_at_rest();
  expect_clean(body.problem, {{1.0, FinalTime{}}}, resting_guess(body.problem, 2.0));
  ControlCase slider(test::slider(0.3));
  slider.problem.horizon = {.n_steps = 3, .shortest_step = 1.0, .longest_step = 3.0};
  slider.seek_plain(1.0);
  slider.start_at_rest();
  expect_clean(slider.problem, {{1.0, FinalTime{}}}, resting_guess(slider.problem, 2.0));
}

TEST(Nlp, DerivativesOfEndConditions) {
  ControlCase at = test::trunk_case(2, 25.0);
  at.problem.final.orientations.push_back(
      {.name = "orientations.last",
       .directors = {multibody::body_direction(5, Vector3d::UnitX()), multibody::body_direction(5, Vector3d::UnitY()),
                     multibody::body_direction(5, Vector3d::UnitZ())}});
  at.problem.final.points.clear();
  at.problem.final.orientations[0].value = Eigen::AngleAxisd(1.5707963267948966, Vector3d::UnitY()).toRotationMatrix();
  expect_clean(at.problem, test::feasibility(), resting_guess(at.problem, 25.0));

  ControlCase rest = test::joint_case(3, 10.0);
  rest.problem.final.coordinates.clear();
  rest.problem.final.equilibrium = {3e4, 1e4};
  expect_clean(rest.problem, test::feasibility(), resting_guess(rest.problem, 10.0));

  ControlCase moving = test::trunk_case(2, 25.0);
  moving.problem.final.momentum = {.kind = MomentumCondition::Kind::rates,
                                   .values = Eigen::VectorXd::Constant(6, 1e-3)};
  expect_clean(moving.problem, {{1.0, KineticEnergy{}}}, resting_guess(moving.problem, 25.0));
}

TEST(Nlp, DerivativesOfPathLimits) {
  ControlCase at = test::trunk_case(2, 25.0);
  at.problem.limits.true_field = 6e4;
  at.problem.limits.pull_in_margin = 0.1;
  at.problem.limits.coordinates.push_back({.name = "joints.first", .rate = 0, .lower = -1.0, .upper = 1.0});
  PointLimit box{.name = "points.tip", .point = at.problem.final.points[0].point};
  box.lower[1] = 0.0;
  box.upper[0] = 500.0;
  at.problem.limits.points.push_back(box);
  expect_clean(at.problem, test::effort_of_fields(12), resting_guess(at.problem, 25.0));
}

TEST(Nlp, DerivativesOfClosedLoops) {
  test::RigidSystem system = test::four_bar({}, test::earth_gravity);
  system.joint_forces.push_back({.joint = 0, .stiffness = 200.0, .damping = 10.0, .control = 0});
  system.controls.push_back({.name = "torque", .unit = {}, .function = 0.0});
  ControlCase at(system);
  at.set_horizon(3, 5.0);
  at.seek_plain(1e3);
  at.start_at_rest();
  at.problem.final.coordinates.push_back({.name = "joints.crank", .rate = 0, .value = 0.3});
  expect_clean(at.problem, {{1.0, KineticEnergy{}}}, resting_guess(at.problem, 5.0));
  at.problem.final.coordinates.clear();
  at.problem.final.equilibrium = {20.0};
  expect_clean(at.problem, test::feasibility(), resting_guess(at.problem, 5.0));
}

/// A four-bar linkage with spring, damper, stop and drive on the joint that closes the loop.
test::RigidSystem linkage_driven_at_its_cut() {
  test::RigidSystem system = test::four_bar({}, test::earth_gravity);
  system.joint_forces.push_back({.joint = 3,
                                 .stiffness = 200.0,
                                 .rest = 0.1,
                                 .damping = 10.0,
                                 .stops = {.upper = -0.5, .stiffness = 300.0, .damping = 20.0},
                                 .control = 0});
  system.joint_forces.push_back({.joint = 0, .damping = 5.0});
  system.controls.push_back({.name = "torque", .unit = {}, .function = 0.0});
  return system;
}

TEST(Nlp, DerivativesOfForcesOnLoopClosingJoints) {
  ControlCase at(linkage_driven_at_its_cut());
  ASSERT_EQ(test::manifold_of(*at.model).tree().cut_joints, std::vector<int>{3});
  at.set_horizon(3, 5.0);
  at.seek_plain(1e3);
  at.start_at_rest();
  at.problem.final.coordinates.push_back({.name = "joints.crank", .rate = 0, .value = 0.3});
  expect_clean(at.problem, {{1.0, KineticEnergy{}}}, resting_guess(at.problem, 5.0));
  at.problem.horizon.longest_step = 8.0;
  expect_clean(at.problem, {{1.0, FinalTime{}}}, resting_guess(at.problem, 6.0));
  at.problem.final.coordinates.clear();
  at.problem.final.equilibrium = {20.0};
  expect_clean(at.problem, test::feasibility(), resting_guess(at.problem, 5.0));
}

TEST(Nlp, DerivativesOfCoordinatesOfLoopClosingJoints) {
  ControlCase at(linkage_driven_at_its_cut());
  at.set_horizon(3, 5.0);
  at.seek_plain(1e3);
  at.start_at_rest();
  const multibody::Joint& joint = test::manifold_of(*at.model).tree().joints[3];
  const auto cut = std::make_shared<multibody::JointCoordinate>(joint, joint.pattern.motions[0]);
  const Trajectory guess = resting_guess(at.problem, 5.0);
  Eigen::VectorXd q(at.problem.model.n_q());
  at.problem.model.manifold->configuration(guess.x[0], q);
  at.problem.final.coordinates.push_back({.name = "joints.rocker", .cut = cut, .value = cut->value(q) - 0.1});
  at.problem.limits.coordinates.push_back({.name = "joints.rocker", .cut = cut, .lower = -3.0, .upper = 3.0});
  expect_clean(at.problem,
               {{0.2, Tracking{.coordinates = {{.cut = cut, .wanted = 0.3}}}},
                {0.3, Terminal{.coordinates = {{.cut = cut, .wanted = 0.4}}}}},
               guess);
}

TEST(Nlp, DerivativesOfLimitsOnTurns) {
  // A ball whose references differ from node to node, and angles.
  ControlCase ball(test::driven_free_body());
  ball.set_horizon(3, 2.0);
  ball.seek_plain(1.0);
  ball.start_at_rest();
  ball.problem.final.momentum.kind = MomentumCondition::Kind::free;
  ball.problem.limits.longest_turn = 1.0;
  const std::vector<std::vector<double>> turning(3, {0.0, 0.0, 0.0, 0.5, 0.2, 0.4});
  expect_clean(ball.problem, test::feasibility(), simulate_guess(ball.problem, 2.0, turning));
  ControlCase joint = test::joint_case(3, 10.0);
  joint.problem.limits.longest_turn = 1.0;
  expect_clean(joint.problem, test::feasibility(), resting_guess(joint.problem, 10.0));
}

TEST(TurnRows, OfABallAreTheRotationBetweenTheNodesWhateverTheirReferences) {
  ControlCase at(test::driven_free_body());
  at.set_horizon(1, 2.0);
  at.start_at_rest();
  const model::Manifold& manifold = *at.model->manifold;
  Trajectory guess = resting_guess(at.problem, 2.0);
  Eigen::VectorXd turn = Eigen::VectorXd::Zero(6);
  turn.tail<3>() = Vector3d(0.3, -0.5, 0.4);
  manifold.retract(guess.x[0], turn, guess.x[1]);
  Layout layout{.n_steps = 1, .n_v = 6};
  layout.place_nodes();
  DiscreteDynamics dynamics(at.problem, layout, guess);
  // Both nodes lie in their references.
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(layout.n);
  ASSERT_TRUE(dynamics.move_to(unknowns));
  const TurnRows rows(*at.model, *dynamics.node(0).chart, guess.x[0], 1.0);
  ASSERT_EQ(rows.n_rows(), 1);
  const double angle = turn.tail<3>().norm();
  EXPECT_NEAR(rows.value(0, 0, dynamics), 1.0 + 2.0 * std::cos(angle), 1e-14);
  EXPECT_NEAR(rows.lower(0), 1.0 + 2.0 * std::cos(1.0), 1e-15);
}

TEST(Nlp, PatternsHoldEveryEntry) {
  // Differences by every unknown touch no entry outside the patterns.
  ControlCase at = test::trunk_case(2, 25.0);
  const Trajectory guess = resting_guess(at.problem, 25.0);
  const auto objectives = test::effort_of_fields(12);
  Transcription nlp(at.problem, objectives, guess);
  Eigen::VectorXd x = nlp.unknowns_of(guess);
  x.array() += 0.02;
  Eigen::MatrixXd allowed = Eigen::MatrixXd::Zero(nlp.n_constraints(), nlp.n_variables());
  for (std::size_t i = 0; i < nlp.jacobian_pattern().size(); ++i) {
    allowed(nlp.jacobian_pattern().rows[i], nlp.jacobian_pattern().columns[i]) += 1.0;
  }
  EXPECT_EQ(allowed.maxCoeff(), 1.0) << "an entry is declared twice";
  Eigen::VectorXd plus;
  Eigen::VectorXd minus;
  for (int k = 0; k < nlp.n_variables(); ++k) {
    const double kept = x[k];
    x[k] = kept + 1e-3;
    nlp.move_to(x);
    nlp.constraints(plus);
    x[k] = kept - 1e-3;
    nlp.move_to(x);
    nlp.constraints(minus);
    x[k] = kept;
    for (int r = 0; r < nlp.n_constraints(); ++r) {
      if (allowed(r, k) > 0.0) continue;
      EXPECT_LT(std::abs(plus[r] - minus[r]), 1e-12) << r << ' ' << k;
    }
  }
}

TEST(Terms, OfTheTrunkHaveTheDerivativesTheyClaim) {
  ControlCase at = test::trunk_case(1, 25.0);
  const std::vector<DerivativeCheck> lines = check_terms(*at.model);
  ASSERT_EQ(lines.size(), 4u);
  for (const DerivativeCheck& line : lines) EXPECT_LT(line.error, 1e-7) << line.what;
}

}  // namespace
}  // namespace muldi::control
