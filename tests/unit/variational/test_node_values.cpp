/// Velocities, energies and momenta at nodes.
#include <gtest/gtest.h>

#include "support/linkages.hpp"
#include "support/random_tree.hpp"
#include "support/systems.hpp"
#include "variational/node_values.hpp"
#include "variational/stepper.hpp"

namespace muldi::variational {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// T = 1/2 (Qp).M^-1 (Qp), Q = 1 - G^T (G M^-1 G^T)^-1 G M^-1 with all constraints (numerics 1.5).
double q_projected_kinetic_energy(const model::Model& model, const State& state) {
  const multibody::TreeManifold& manifold = test::manifold_of(model);
  std::vector<multibody::RigidBody> bodies;
  std::vector<model::Bilinear> rows = manifold.tree_rows();
  rows.insert(rows.end(), manifold.loop_rows().begin(), manifold.loop_rows().end());
  const MatrixXd G = test::dense_jacobian(rows, state.q);
  math::BlockMatrix K(*model.pattern);
  const VectorXd zero = VectorXd::Zero(state.q.size());
  std::vector<double> u(model.controls.size());
  model.evaluate_controls(0.0, u);
  model.tangent({.q0 = state.q, .q1 = state.q, .q = state.q, .v = zero, .u = u}, model::TangentWeights::mass(), K);
  const MatrixXd M_inverse = K.dense().inverse();
  const VectorXd lambda = (G * M_inverse * G.transpose()).ldlt().solve(G * M_inverse * state.p);
  const VectorXd projected = state.p - G.transpose() * lambda;
  return 0.5 * projected.dot(M_inverse * projected);
}

void expect_same_energy(const test::RigidSystem& system, const State& start, double dt) {
  const auto model = test::make_model(system);
  Stepper stepper(*model, dt, {});
  NodeEvaluator nodes(*model, "auto");
  NodeValues values;
  State state = start;
  std::vector<double> u(model->controls.size());
  for (int n = 0; n < 20; ++n) {
    model->evaluate_controls(dt * (n + 0.5), u);
    ASSERT_EQ(stepper.advance(state, u).status, Status::running);
    ASSERT_TRUE(nodes.evaluate(state, u, u, values));
    const double expected = q_projected_kinetic_energy(*model, state);
    ASSERT_NEAR(values.total.kinetic, expected, 1e-10 * expected);
  }
}

TEST(NodeValues, KineticEnergyOfTheNullSpaceIsThatOfTheProjector) {
  std::mt19937 random(120);
  for (int n = 0; n < 10; ++n) {
    const test::RigidSystem system = test::random_forest(random, {.n_bodies = 5, .n_chains = 2});
    const auto model = test::make_model(system);
    const State start = test::state_at(*model, model->manifold->reference(),
                                       test::random_entries(random, model->manifold->n_v(), 0.02));
    expect_same_energy(system, start, 1.0);
  }
  const test::RigidSystem four_bar = test::four_bar({}, test::earth_gravity);
  expect_same_energy(four_bar, test::state_at_rest(*test::make_model(four_bar)), 1.0);
}

TEST(NodeValues, RecoverTheVelocitiesOfTheInitialState) {
  std::mt19937 random(121);
  const test::RigidSystem system = test::random_forest(random, {.n_bodies = 6, .n_chains = 2});
  const auto model = test::make_model(system);
  const VectorXd w = test::random_entries(random, model->manifold->n_v(), 0.1);
  const State state = test::state_at(*model, test::random_coordinates(random, *model->manifold), w);
  NodeEvaluator nodes(*model, "auto");
  NodeValues values;
  ASSERT_TRUE(nodes.evaluate(state, {}, {}, values));
  EXPECT_LT((values.rate - w).norm(), 1e-10 * w.norm());
  EXPECT_LT((values.momentum - state.p).norm(), 1e-10 * state.p.norm());
}

TEST(NodeValues, OfALoopHaveAdmissibleVelocities) {
  const auto model = test::make_model(test::bennett(1.2));
  const multibody::TreeManifold& manifold = test::manifold_of(*model);
  // Momenta that no admissible motion has.
  State state = test::state_at(*model, manifold.reference(), Eigen::Vector3d(0.1, 0.2, -0.1));
  NodeEvaluator nodes(*model, "auto");
  NodeValues values;
  ASSERT_TRUE(nodes.evaluate(state, {}, {}, values));
  const MatrixXd G = test::dense_jacobian(manifold.loop_rows(), state.q);
  EXPECT_LT((G * values.v).norm(), 1e-12);
  EXPECT_GT(values.v.norm(), 1e-3);
  // The impulse of the loop explains the rest of the momentum: T^T (p - M v - G^T mu) = 0.
  const VectorXd rest = state.p - values.momentum - G.transpose() * nodes.loop_impulse();
  EXPECT_LT((test::dense_null_space(manifold, state.x).transpose() * rest).norm(), 1e-9);
}

TEST(NodeValues, TellTheElectricEnergyOnBothSidesOfAJump) {
  const auto model = test::make_model(test::membrane(3e4, 0.0));
  const State state = test::state_at_rest(*model);
  NodeEvaluator nodes(*model, "auto");
  NodeValues values;
  const std::array<double, 1> before{1e4};
  const std::array<double, 1> after{2e4};
  ASSERT_TRUE(nodes.evaluate(state, before, after, values));
  // -1/2 V eps E^2 at the reference length, V = 400.
  EXPECT_NEAR(values.total.electric, -0.5 * 400.0 * 3.7 * test::eps0 * 1e8, 1e-15);
  EXPECT_NEAR(values.electric_after, 4.0 * values.total.electric, 1e-15);
}

}  // namespace
}  // namespace muldi::variational
