/// The static tangent against differences of the residual on the manifold.
#include <gtest/gtest.h>

#include "math/derivative_check.hpp"
#include "statics/equilibrium.hpp"
#include "support/linkages.hpp"
#include "support/random_tree.hpp"
#include "support/systems.hpp"

namespace muldi::statics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void expect_tangent(const model::Model& model, const StaticState& state, const std::vector<double>& u) {
  EquilibriumSolver solver(model, {});
  solver.linearise(state, u);
  const MatrixXd A = solver.tangent();
  const MatrixXd B = solver.loop_rows();
  const MatrixXd Z = solver.loop_basis();
  const auto residual = [&](const VectorXd& w) -> VectorXd {
    StaticState at = state;
    model.manifold->retract(state.x, w, at.x);
    solver.linearise(at, u);
    VectorXd gaps(Z.rows());
    model.manifold->constraints(solver.configuration(), gaps);
    VectorXd both(solver.residual().size() + Z.cols());
    both << -solver.residual(), Z.transpose() * gaps;
    return both;
  };
  const VectorXd zero = VectorXd::Zero(model.manifold->n_v());
  const MatrixXd expected =
      math::difference_jacobian(residual, zero, 0.01 * model.manifold->rate_scale().cwiseMin(1.0));
  EXPECT_LT(math::derivative_error(A, expected.topRows(A.rows())).relative, 1e-10);
  if (B.rows() > 0) {
    EXPECT_LT(math::derivative_error(B, expected.bottomRows(B.rows())).relative, 1e-10);
  }
}

TEST(StaticTangent, OfTheTrunkOffItsEquilibrium) {
  const std::vector<double> fields = test::odd_fields(3e4);
  const auto model = test::make_model(test::trunk(fields));
  expect_tangent(*model, {VectorXd{{0.1, -0.05, 0.2, 0.15, -0.1, 0.05}}, VectorXd()}, fields);
}

TEST(StaticTangent, OfTreesWithSpringsLoadsAndJointSprings) {
  std::mt19937 random(90);
  for (int n = 0; n < 10; ++n) {
    test::RigidSystem system = test::random_forest(random, {.n_bodies = 5, .n_chains = 1});
    system.springs.push_back({.name = "s",
                              .element = {.stiffness = 1e-3, .rest_length = 20.0},
                              .a1 = {0, Eigen::Vector3d(1.0, 2.0, 3.0)},
                              .a2 = {4, Eigen::Vector3d(3.0, -1.0, 4.0)}});
    system.loads.push_back({.name = "l",
                            .kind = multibody::Load::Kind::torque,
                            .frame = multibody::Load::Frame::body,
                            .body = 2,
                            .direction = Eigen::Vector3d(0.1, 0.2, 0.3)});
    for (int j = 0; j < static_cast<int>(system.joints.size()); ++j) {
      const auto motions = system.joints[static_cast<std::size_t>(j)].pattern.motions;
      for (std::size_t k = 0; k < motions.size(); ++k) {
        if (motions[k].kind == multibody::Motion::Kind::ball) continue;
        system.joint_forces.push_back({.joint = j, .motion = k, .stiffness = 0.3, .rest = 0.1});
      }
    }
    const auto model = test::make_model(system);
    expect_tangent(*model, {test::random_coordinates(random, *model->manifold), VectorXd()}, {});
  }
}

TEST(StaticTangent, OfALoopWithItsMultipliers) {
  std::mt19937 random(91);
  test::RigidSystem system = test::four_bar({}, 0.01);
  for (int j = 0; j < 4; ++j)
    system.joint_forces.push_back({.joint = j, .stiffness = 5.0, .rest = 0.1, .constant = 2.0});
  const auto model = test::make_model(system);
  expect_tangent(*model, {VectorXd{{0.1, -0.2, 0.3}}, VectorXd{{0.7, -1.1, 0.4, 0.9, -0.3}}}, {});
}

TEST(StaticTangent, LoadRateOfDrivesIsTheSlopeByTheControls) {
  // In the joints of the tree and in the one that closes the loop.
  test::RigidSystem system = test::four_bar({}, 0.01);
  for (int j = 0; j < 4; ++j) {
    system.joint_forces.push_back({.joint = j, .control = j % 2, .control_factor = 1.0 + j});
  }
  system.controls.assign(2, {.name = "u", .unit = base::dimension::torque, .function = 0.0});
  const auto model = test::make_model(system);
  EquilibriumSolver solver(*model, {});
  const StaticState state{VectorXd{{0.1, -0.2, 0.3}}, VectorXd{{0.7, -1.1, 0.4, 0.9, -0.3}}};
  solver.linearise(state, std::vector{0.3, 0.5});
  const VectorXd before = solver.residual();
  const VectorXd rate = solver.load_rate(std::vector{0.3, 0.5}, std::vector{2.0, -1.0});
  solver.linearise(state, std::vector{2.3, -0.5});
  EXPECT_GT(rate.norm(), 1.0);
  EXPECT_LT((rate - (solver.residual() - before)).norm(), 1e-13 * rate.norm());  // linear in the drives
}

TEST(StaticTangent, LoadRateIsTheSlopeByTheControls) {
  const std::vector<double> fields = test::odd_fields(3e4);
  const auto model = test::make_model(test::trunk(fields));
  EquilibriumSolver solver(*model, {});
  const StaticState state{VectorXd{{0.1, -0.05, 0.2, 0.15, -0.1, 0.05}}, VectorXd()};
  std::vector<double> direction(12);
  for (std::size_t k = 0; k < 12; ++k) direction[k] = 1e3 * static_cast<double>(k);
  const auto residual = [&](const VectorXd& s) -> VectorXd {
    std::vector<double> u = fields;
    for (std::size_t k = 0; k < 12; ++k) u[k] += s[0] * direction[k];
    solver.linearise(state, u);
    return solver.residual();
  };
  const VectorXd expected =
      math::difference_jacobian(residual, VectorXd::Zero(1), VectorXd::Constant(1, 1.0));  // quadratic in the fields
  solver.linearise(state, fields);
  EXPECT_LT((solver.load_rate(fields, direction) - expected).norm(), 1e-11 * expected.norm());
}

}  // namespace
}  // namespace muldi::statics
