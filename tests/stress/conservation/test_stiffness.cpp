/// Springs whose stiffnesses differ by 1e8 (numerics 5 no. 18).
#include <gtest/gtest.h>

#include <iostream>

#include "multibody/registry.hpp"
#include "support/figure.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi {
namespace {

using Eigen::Vector3d;

TEST(Stiffness, RatioOfAHundredMillionConverges) {
  // The stiff spring holds the angle between the two bodies, the soft one draws the second to ground.
  test::RigidSystem system = test::double_pendulum();
  system.springs = {{.name = "soft",
                     .element = {.stiffness = 1e-3, .rest_length = 50.0},
                     .a1 = {multibody::ground, Vector3d(150.0, 120.0, 40.0)},
                     .a2 = system.end_at(1, Vector3d(184.0, 0.0, 0.0))},
                    {.name = "stiff",
                     .element = {.stiffness = 1e5, .rest_length = std::hypot(60.0, 20.0)},
                     .a1 = system.end_at(0, Vector3d(62.0, 20.0, 0.0)),
                     .a2 = system.end_at(1, Vector3d(122.0, 0.0, 0.0))}};
  const auto model = test::make_model(system);
  const auto end = [&](double dt, long steps) {
    double violation = 0.0;
    const test::Run done = test::run(*model, test::state_at_rest(*model), {.dt = dt, .steps = steps},
                                     [&](const variational::NodeRecord& node) {
                                       violation = std::max(violation, model->manifold->violation(node.state.q));
                                     });
    EXPECT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
    test::record_figure("18", "springs 1 to 1e8, violation of constraints", violation, 1e-10);
    std::cout << "violation " << violation << ", iterations a step "
              << static_cast<double>(done.result.statistics.iterations) / static_cast<double>(steps) << '\n';
    return done.state.q;
  };
  const double apart = (end(1.0, 1000) - end(0.1, 10'000)).lpNorm<Eigen::Infinity>() / system.length;
  std::cout << "dt against dt/10: " << apart << '\n';
  test::record_figure("18", "springs 1 to 1e8, dt against dt/10, over the size", apart, 1e-4);
}

/// Condition number of the Newton matrix of a step from rest, in natural sizes.
double condition_of_step(const model::Model& model, double dt) {
  const multibody::TreeManifold& manifold = test::manifold_of(model);
  const variational::State state = test::state_at_rest(model);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(model.n_q());
  const auto n_x = static_cast<std::size_t>(state.x.size());
  math::BlockMatrix K(*model.pattern);
  model.tangent({.q0 = state.q,
                 .q1 = state.q,
                 .q = state.q,
                 .v = zero,
                 .u = {},
                 .dt = dt,
                 .x0 = {state.x.data(), n_x},
                 .x1 = {state.x.data(), n_x}},
                model::TangentWeights::step(dt), K);
  const Eigen::MatrixXd T = test::dense_null_space(manifold, state.x);
  const Eigen::VectorXd scale = manifold.rate_scale();
  const Eigen::MatrixXd A = scale.asDiagonal() * (T.transpose() * K.dense() * T) * scale.asDiagonal();
  const Eigen::VectorXd values = A.jacobiSvd().singularValues();
  return values[0] / values[values.size() - 1];
}

TEST(Stiffness, ConditionOfTheStepIsThatOfTheMassesAndSprings) {
  // Two bodies in a row whose masses differ by a million: the lighter one's inertia beside the heavier one's.
  for (const double ratio : {1e-6, 1e6}) {
    test::RigidSystem system = test::double_pendulum();
    system.bodies[1].mass *= ratio;
    system.bodies[1].inertia *= ratio;
    const double condition = condition_of_step(*test::make_model(system), 1.0);
    test::record_figure("18", "condition number of a step, masses 1 to " + test::short_number(ratio), condition, 1e8);
  }
}

}  // namespace
}  // namespace muldi
