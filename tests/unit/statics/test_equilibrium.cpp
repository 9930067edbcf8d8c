/// Static equilibria: published angles, convergence, stability, what has none.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "multibody/registry.hpp"
#include "statics/equilibrium.hpp"
#include "support/figure.hpp"
#include "support/linkages.hpp"
#include "support/random_tree.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi::statics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

StaticState scene_pose(const model::Model& model) {
  return {model.manifold->reference(), VectorXd::Zero(model.manifold->n_loop_rows())};
}

/// The equilibrium under the model's controls at t = 0, found from the scene
/// pose.
StaticState equilibrium(const model::Model& model, EquilibriumReport* report = nullptr) {
  std::vector<double> u(model.controls.size());
  model.evaluate_controls(0.0, u);
  StaticState state = scene_pose(model);
  EquilibriumSolver solver(model, {});
  const EquilibriumReport done = solver.solve(state, u);
  EXPECT_TRUE(done.converged);
  if (report != nullptr) *report = done;
  return state;
}

TEST(Equilibrium, OfTheMuscleJointIsThePublishedAngle) {
  EquilibriumReport report;
  const auto model = test::make_model(test::muscle_joint(3e4));
  const StaticState state = equilibrium(*model, &report);
  // reference-results A, independent program; the charged upper muscle pushes
  // the body down.
  EXPECT_NEAR(std::abs(state.x[0]) / test::degree, 7.7284947404, 1e-10);
  EXPECT_EQ(report.stability, Stability::stable);
  EXPECT_LE(report.iterations, 8);
}

TEST(Equilibrium, OfTheMuscleJointWithTheTrunksMaterial) {
  test::RigidSystem system = test::muscle_joint(3e4);
  for (auto& muscle : system.muscles) muscle.element.electric_law = muscles::ElectricLaw::ideal(3.7, test::eps0);
  const StaticState state = equilibrium(*test::make_model(system));
  EXPECT_NEAR(std::abs(state.x[0]) / test::degree, 9.5077006219, 1e-10);
}

TEST(Equilibrium, OfTheTrunkIsTheReferenceTip) {
  const auto model = test::make_model(test::trunk(test::odd_fields(3e4)));
  const StaticState state = equilibrium(*model);
  for (const double angle : state.x) EXPECT_NEAR(std::abs(angle) / test::degree, 9.507700621871, 1e-11);
  const test::End tip = test::trunk_tip();
  const Vector3d at =
      multibody::body_point(tip.body, tip.local).value(test::configuration_at(*model->manifold, state.x));
  EXPECT_LT((at - Vector3d(-95.8649066679, 274.0421097373, 73.0752202916)).norm(), 1e-7);
}

TEST(Equilibrium, OfFreeActuatorsAreTheTabulatedStretches) {
  // numerics 3.1, mu 0.7/3, eps_r 3.7, stable branch.
  const std::vector<std::pair<double, double>> table{{1e4, 0.995275419992},
                                                     {2e4, 0.980531432033},
                                                     {3e4, 0.953727609917},
                                                     {4e4, 0.909804644007},
                                                     {5e4, 0.833389955634}};
  for (const auto& [field, stretch] : table) {
    EXPECT_NEAR(equilibrium(*test::make_model(test::membrane(field, 0.01))).x[0], stretch, 1e-11);
    EXPECT_NEAR(equilibrium(*test::make_model(test::round_actuator(field, 0.01))).x[0], 40.0 * stretch, 1e-9);
  }
}

TEST(Equilibrium, JustBelowPullInIsThatOfTheQuartic) {
  // E = 0.999 E*: Lambda^4 - Lambda + beta = 0 solved by bisection between
  // Lambda* and 1 (numerics 5 no. 8).
  const double field = 0.999 * 58009.6395041;
  const double beta = 3.7 * test::eps0 * field * field / (0.7 / 3.0);
  double low = std::pow(4.0, -1.0 / 3.0);
  double high = 1.0;
  for (int n = 0; n < 100; ++n) {
    const double middle = 0.5 * (low + high);
    (std::pow(middle, 4) - middle + beta < 0.0 ? low : high) = middle;
  }
  EquilibriumReport report;
  test::record_near("8", "stretch at 0.999 of the critical field",
                    equilibrium(*test::make_model(test::membrane(field, 0.0)), &report).x[0], low, 1e-8);
  EXPECT_EQ(report.stability, Stability::stable);
}

TEST(Equilibrium, BeyondPullInIsNotFound) {
  const auto model = test::make_model(test::membrane(0.0, 0.0));
  StaticState state = scene_pose(*model);
  EquilibriumSolver solver(*model, {});
  const std::vector<double> u{1.001 * 58009.6395041};
  EXPECT_FALSE(solver.solve(state, u).converged);
  EXPECT_EQ(state.x[0], 1.0) << "the state is left as it was";
}

TEST(Equilibrium, ConvergesQuadratically) {
  const auto model = test::make_model(test::trunk(test::odd_fields(3e4)));
  const std::vector<double> u = test::odd_fields(3e4);
  const StaticState exact = equilibrium(*model);
  std::map<int, double> errors;
  for (double tolerance = 0.3; tolerance > 1e-11; tolerance *= 0.3) {
    StaticState state = scene_pose(*model);
    EquilibriumSolver solver(*model, {.tolerance = tolerance});
    const EquilibriumReport report = solver.solve(state, u);
    ASSERT_TRUE(report.converged);
    errors[report.iterations] = (state.x - exact.x).lpNorm<Eigen::Infinity>();
  }
  ASSERT_GE(errors.size(), 3u);
  for (auto at = errors.begin(); std::next(at) != errors.end(); ++at) {
    EXPECT_LT(std::next(at)->second, 10.0 * at->second * at->second + 1e-13);
  }
}

TEST(Equilibrium, OfAHangingChainIsWhereItsDynamicsSettle) {
  // Joint springs and dampers, gravity across: the run ends where the solver
  // finds the equilibrium.
  test::RigidSystem system = test::revolute_chain(3);
  for (int j = 0; j < 3; ++j) {
    system.joint_forces.push_back({.joint = j, .stiffness = 60.0, .rest = 0.2, .damping = 4e3});
  }
  const auto model = test::make_model(system);
  const StaticState state = equilibrium(*model);
  const test::Run run = test::run(*model, test::state_at_rest(*model), {.dt = 10.0, .steps = 6000});
  ASSERT_EQ(run.result.status, variational::Status::completed);
  EXPECT_GT(state.x.norm(), 0.3);
  EXPECT_LT((run.state.x - state.x).lpNorm<Eigen::Infinity>(), 1e-8);
}

TEST(Equilibrium, HangsFreelyTurningJointsStraightDown) {
  // A pendulum from horizontal, without any spring.
  EquilibriumReport report;
  const StaticState state = equilibrium(*test::make_model(test::pendulum()), &report);
  EXPECT_NEAR(std::abs(std::remainder(state.x[0], 2.0 * std::acos(-1.0))), 0.5 * std::acos(-1.0), 1e-10);
  EXPECT_LT(std::sin(state.x[0]), 0.0) << "below";
  EXPECT_EQ(report.stability, Stability::stable);
}

TEST(Equilibrium, StandingUpIsUnstable) {
  const auto model = test::make_model(test::pendulum());
  StaticState state{VectorXd::Constant(1, 0.5 * std::acos(-1.0)), VectorXd()};
  EquilibriumSolver solver(*model, {});
  solver.linearise(state, {});
  EXPECT_LT(solver.residual().norm(), 1e-13);
  EXPECT_EQ(solver.stability(), Stability::unstable);
  EXPECT_NEAR(solver.tangent()(0, 0), -40.0 * test::earth_gravity * 46.0, 1e-10);
}

TEST(Equilibrium, KnowsMotionsWithoutStiffness) {
  EquilibriumReport report;
  static_cast<void>(equilibrium(*test::make_model(test::pendulum(0.0)), &report));
  EXPECT_EQ(report.stability, Stability::free);
  // A top on a ball joint hangs down but turns freely about its axis.
  test::RigidSystem top = test::heavy_top(2.5);
  const auto model = test::make_model(top);
  static_cast<void>(equilibrium(*model, &report));
  EXPECT_EQ(report.stability, Stability::free);
}

TEST(Equilibrium, OfALoopHasMultipliersThatHoldIt) {
  const auto model = test::make_model(test::four_bar({}, test::earth_gravity));
  EquilibriumReport report;
  const StaticState state = equilibrium(*model, &report);
  EXPECT_EQ(report.stability, Stability::stable);
  EquilibriumSolver solver(*model, {});
  solver.linearise(state, {});
  EXPECT_LT(solver.residual().norm(), 1e-9);
  EXPECT_LT(model->manifold->violation(solver.configuration()), 1e-12);
  EXPECT_GT(state.multipliers.norm(), 1.0);
}

TEST(Equilibrium, OfASystemThatCannotMoveIsItsPose) {
  test::RigidSystem system;
  system.add_body(1.0, Vector3d::Ones(), {});
  system.connect(multibody::Fixed::pattern, {multibody::ground, 0}, Vector3d::Zero());
  const auto model = test::make_model(system);
  EquilibriumReport report;
  static_cast<void>(equilibrium(*model, &report));
  EXPECT_EQ(report.stability, Stability::stable);
}

TEST(Equilibrium, DoesNotDependOnThePlaceOfTheScene) {
  std::mt19937 random(140);
  const test::RigidSystem system = test::trunk(test::odd_fields(3e4));
  const StaticState at = equilibrium(*test::make_model(system));
  for (int n = 0; n < 3; ++n) {
    const StaticState moved = equilibrium(*test::make_model(system.moved(test::random_pose(random, 300.0))));
    EXPECT_LT((moved.x - at.x).lpNorm<Eigen::Infinity>(), 1e-10);
  }
}

}  // namespace
}  // namespace muldi::statics
