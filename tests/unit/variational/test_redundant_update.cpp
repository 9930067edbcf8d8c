/// The update on the manifold against the thesis's redundant one (numerics 1.8 i, 5 no. 19).
#include <gtest/gtest.h>

#include "multibody/registry.hpp"
#include "support/linkages.hpp"
#include "support/random_tree.hpp"
#include "support/redundant_update.hpp"
#include "support/systems.hpp"
#include "variational/stepper.hpp"

namespace muldi::variational {
namespace {

using Eigen::VectorXd;

/// Both updates side by side; returns the largest difference in q over the run, in sizes of the scene.
double largest_difference(const test::RigidSystem& system, const State& start, double dt, int steps) {
  const auto model = test::make_model(system);
  Stepper stepper(*model, dt, {.tolerance = 1e-12});
  const test::RedundantUpdate redundant(*model, dt);
  State state = start;
  VectorXd q = state.q;
  VectorXd p = state.p;
  std::vector<double> u(model->controls.size());
  double largest = 0.0;
  for (int n = 0; n < steps; ++n) {
    model->evaluate_controls(dt * (n + 0.5), u);
    const StepReport report = stepper.advance(state, u);
    EXPECT_EQ(report.status, Status::running) << report.sentence;
    const int iterations = redundant.advance(q, p, u);
    EXPECT_GT(iterations, 0) << "step " << n;
    if (iterations < 0 || report.status != Status::running) return 1.0;
    largest = std::max(largest, (q - state.q).lpNorm<Eigen::Infinity>() / system.length);
  }
  EXPECT_GT((state.q - start.q).lpNorm<Eigen::Infinity>(), 1e-3 * system.length) << "it moves";
  return largest;
}

TEST(RedundantUpdate, AgreesOnTheDoublePendulum) {
  const test::RigidSystem system = test::double_pendulum();
  const auto model = test::make_model(system);
  EXPECT_LT(largest_difference(system, test::state_at_rest(*model), 2.0, 400), 1e-8);
}

TEST(RedundantUpdate, AgreesOnTheMuscleJointAndTheTrunk) {
  const test::RigidSystem joint = test::muscle_joint(3e4);
  EXPECT_LT(largest_difference(joint, test::state_at_rest(*test::make_model(joint)), 2.0, 300), 1e-8);
  const test::RigidSystem trunk = test::trunk(test::odd_fields(3e4));
  EXPECT_LT(largest_difference(trunk, test::state_at_rest(*test::make_model(trunk)), 5.0, 100), 1e-8);
}

TEST(RedundantUpdate, AgreesOnRandomTrees) {
  std::mt19937 random(110);
  for (int n = 0; n < 10; ++n) {
    const test::RigidSystem system =
        test::random_forest(random, {.n_bodies = 5, .n_chains = 2, .with_fixed_joints = true});
    const auto model = test::make_model(system);
    const State start = test::state_at(*model, model->manifold->reference(),
                                       test::random_entries(random, model->manifold->n_v(), 0.01));
    EXPECT_LT(largest_difference(system, start, 1.0, 100), 1e-8);
  }
}

TEST(RedundantUpdate, AgreesWithSpringsDampersAndDrivesInTheJoints) {
  std::mt19937 random(112);
  for (int n = 0; n < 10; ++n) {
    test::RigidSystem system = test::random_forest(random, {.n_bodies = 5, .n_chains = 2, .with_fixed_joints = true});
    for (int j = 0; j < static_cast<int>(system.joints.size()); ++j) {
      const auto motions = system.joints[static_cast<std::size_t>(j)].pattern.motions;
      for (std::size_t k = 0; k < motions.size(); ++k) {
        if (motions[k].kind == multibody::Motion::Kind::ball) continue;
        const double size = motions[k].kind == multibody::Motion::Kind::slide ? 1e-3 : 1.0;
        system.joint_forces.push_back({.joint = j,
                                       .motion = k,
                                       .stiffness = 10.0 * size,
                                       .damping = 100.0 * size,
                                       .stops = {.lower = -0.05, .upper = 0.05, .stiffness = 30.0 * size},
                                       .constant = 2.0 * size});
      }
    }
    const auto model = test::make_model(system);
    const State start = test::state_at(*model, model->manifold->reference(),
                                       test::random_entries(random, model->manifold->n_v(), 0.01));
    EXPECT_LT(largest_difference(system, start, 1.0, 100), 1e-8);
  }
}

TEST(RedundantUpdate, AgreesOnClosedLoops) {
  test::RigidSystem four_bar = test::four_bar({}, test::earth_gravity);
  for (int j = 0; j < 4; ++j) four_bar.joint_forces.push_back({.joint = j, .stiffness = 20.0, .damping = 100.0});
  EXPECT_LT(largest_difference(four_bar, test::state_at_rest(*test::make_model(four_bar)), 1.0, 300), 1e-8);
  const test::RigidSystem slider = test::slider_crank(test::earth_gravity);
  EXPECT_LT(largest_difference(slider, test::state_at_rest(*test::make_model(slider)), 1.0, 300), 1e-8);
  const test::RigidSystem bennett = test::bennett(1.2);
  const auto model = test::make_model(bennett);
  const State start = test::state_at(*model, model->manifold->reference(), test::admissible_rates(*model, 0, 0.02));
  // More than a turn, through the places where two fixed rows would lose rank.
  EXPECT_LT(largest_difference(bennett, start, 1.0, 400), 1e-8);
}

TEST(RedundantUpdate, AgreesOnLoopsWhoseRowsTurnWithTheirBodies) {
  // Cut joints with rows that turn: their space at the node is not that at the middle of the step.
  std::mt19937 random(111);
  for (const multibody::JointPattern& pattern : {multibody::Universal::pattern, multibody::Cylindrical::pattern,
                                                 multibody::Planar::pattern, multibody::Prismatic::pattern}) {
    test::RigidSystem system;
    system.gravity = Eigen::Vector3d(0.0, 0.0, -test::earth_gravity);
    for (int i = 0; i < 5; ++i) {
      system.add_body(10.0 + i, Eigen::Vector3d(2000.0, 2200.0, 2500.0), test::random_pose(random, 50.0));
      // Breadth first from body 0, the loop is cut between bodies 2 and 3.
      system.connect(i == 3 ? pattern : multibody::Spherical::pattern, {i - 1, i}, test::random_vector(random, 50.0),
                     test::random_rotation(random));
    }
    system.connect(multibody::Cylindrical::pattern, {4, 0}, test::random_vector(random, 50.0),
                   test::random_rotation(random));
    const auto model = test::make_model(system);
    ASSERT_EQ(test::manifold_of(*model).tree().cut_joints, std::vector<int>{3});
    ASSERT_EQ(model->manifold->n_c(), pattern.n_constraints());
    EXPECT_LT(largest_difference(system, test::state_at_rest(*model), 1.0, 100), 1e-8);
  }
}

}  // namespace
}  // namespace muldi::variational
