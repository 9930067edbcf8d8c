/// Nodes that follow rigid bodies, against the same equations with multipliers (numerics 1.9, 5 no. 29).
#include <gtest/gtest.h>

#include <random>

#include "base/parallel.hpp"
#include "multibody/registry.hpp"
#include "support/linkages.hpp"
#include "support/tied_referee.hpp"
#include "support/trajectory.hpp"
#include "variational/stepper.hpp"

namespace muldi::fem {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double eps = 3.0 * 8.8542e-12;

test::TiedSystem driven_hinge(Formulation formulation, std::array<int, 3> cells, double viscosity) {
  test::TiedSystem system = test::hinge_with_muscle(
      {.cells = cells, .formulation = formulation, .viscosity = viscosity, .field = 0, .permittivity = eps});
  system.rigid.controls = {{.name = "field", .unit = {}, .function = 2e4}};
  return system;
}

TEST(Ties, GatherIsTheTransposeOfFollow) {
  const auto model = test::make_model(driven_hinge(Formulation::displacement, {1, 1, 2}, 0.0));
  const model::Substructure& part = *model->substructures[0];
  std::mt19937 random(3);
  std::normal_distribution<double> any;
  VectorXd v(model->n_q());
  VectorXd f(model->n_q());
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = any(random), f[i] = any(random);
  part.follow({}, v);
  part.keep_free(v);  // zeroes what follow wrote
  VectorXd followed = v;
  part.follow({}, followed);
  VectorXd gathered = f;
  part.gather(gathered);
  EXPECT_NEAR((followed - v).dot(f), v.dot(gathered - f), 1e-12);
  EXPECT_GT(std::abs((followed - v).dot(f)), 0.1);
}

TEST(Ties, MoveAsWithMultipliersAndWithTheSameForces) {
  for (const Formulation formulation :
       {Formulation::displacement, Formulation::mean_dilatation, Formulation::incompressible}) {
    const test::TiedSystem system = driven_hinge(formulation, {1, 1, 3}, 0.05);
    const auto model = test::make_model(system);
    const double dt = 0.2;
    const std::vector<double> u = {2e4};
    variational::State state = test::tied_state(*model, dt, VectorXd::Constant(1, 0.02));
    variational::State referred = state;
    test::TiedReferee referee(system, dt);
    variational::Stepper stepper(*model, dt, {.tolerance = 1e-12});
    for (int step = 0; step < 5; ++step) {
      ASSERT_EQ(stepper.advance(state, u).status, variational::Status::running);
      referee.advance(referred, u);
      EXPECT_LT((state.x - referred.x).lpNorm<Eigen::Infinity>(), 1e-9);
      EXPECT_LT((state.q - referred.q).lpNorm<Eigen::Infinity>(), 1e-9);
      const Solid& solid = test::solid_of(*model, 0);
      double missed = 0.0;
      double largest = 0.0;
      for (std::size_t t = 0; t < solid.data().ties.size(); ++t) {
        const Vector3d force =
            stepper.constraint_force().segment<3>(solid.q_slice().first + 3 * solid.data().ties[t].node);
        const Vector3d expected = referee.forces().col(static_cast<Eigen::Index>(t));
        missed = std::max(missed, (force - expected).norm());
        largest = std::max(largest, expected.norm());
      }
      EXPECT_LT(missed, 1e-9);
      EXPECT_GT(largest, 1e-2);
    }
  }
}

TEST(Ties, HoldExactlyInEveryStep) {
  const auto model = test::make_model(driven_hinge(Formulation::incompressible, {2, 2, 4}, 0.0));
  const Solid& solid = test::solid_of(*model, 0);
  double error = 0.0;
  double drift = 0.0;
  const test::Run done = test::run(*model, test::tied_state(*model, 0.5, VectorXd::Constant(1, 0.01)),
                                   {.dt = 0.5, .steps = 60}, [&](const variational::NodeRecord& node) {
                                     VectorXd followed = node.state.q;
                                     solid.ties().follow(solid.q_slice().first, followed);
                                     error = std::max(error, (followed - node.state.q).lpNorm<Eigen::Infinity>());
                                     drift = std::max(drift, model->manifold->violation(node.state.q));
                                   });
  EXPECT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
  EXPECT_EQ(error, 0.0);
  EXPECT_LT(drift, 1e-11);
}

/// The hinge with some of the upper nodes tied only.
void expect_motion_with(const test::Where& tied) {
  test::TiedSystem system = driven_hinge(Formulation::incompressible, {2, 2, 4}, 0.05);
  SolidDescription bar = system.solids[0];
  bar.ties.clear();
  bar.hosts.clear();
  system.tie(bar, tied, 0);
  ASSERT_FALSE(bar.ties.empty());
  system.solids[0] = bar;
  const auto model = test::make_model(system);
  const test::Run done = test::run(*model, test::tied_state(*model, 0.2, VectorXd::Constant(1, 0.01)),
                                   {.dt = 0.2, .steps = 50, .step = {.tolerance = 1e-11}});
  EXPECT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
  EXPECT_GT(std::abs(done.state.x[0]), 1e-3);
}

TEST(Ties, OfOneNodeAreAHinge) {
  expect_motion_with([](const Vector3d& X) { return (X - Vector3d(6.0, 0.0, 8.0)).norm() < 1e-9; });
}

TEST(Ties, OfNodesInALineAreAnAxis) {
  expect_motion_with([](const Vector3d& X) { return std::abs(X[2] - 8.0) < 1e-9 && std::abs(X[1]) < 1e-9; });
}

TEST(Ties, ARestartTakesTheSameStepsBitForBit) {
  const test::TiedSystem system = driven_hinge(Formulation::incompressible, {2, 2, 4}, 0.05);
  const double dt = 0.5;
  const auto whole = test::make_model(system);
  const variational::State start = test::tied_state(*whole, dt, VectorXd::Constant(1, 0.02));
  const test::Run unbroken = test::run(*whole, start, {.dt = dt, .steps = 30});
  const auto before = test::make_model(system);
  const test::Run half = test::run(*before, start, {.dt = dt, .steps = 13});
  const auto after = test::make_model(system);
  VectorXd memory = VectorXd::Zero(before->substructures[0]->n_memory());
  before->substructures[0]->store_memory(memory);
  after->substructures[0]->restore_memory(memory);
  const test::Run rest = test::run(*after, half.state, {.dt = dt, .steps = 30});
  ASSERT_EQ(rest.result.status, variational::Status::completed) << rest.result.sentence;
  EXPECT_GT(half.state.factor.q1.size(), 0);
  EXPECT_TRUE(rest.state.q == unbroken.state.q);
  EXPECT_TRUE(rest.state.p == unbroken.state.p);
  EXPECT_TRUE(rest.state.y == unbroken.state.y);
}

TEST(Ties, MusclesSideBySideGiveTheSameBitsForAnyNumberOfThreads) {
  test::TiedSystem system =
      test::chain_with_muscles(2, {.cells = {1, 1, 6}, .side = 8.0, .viscosity = 0.1, .permittivity = eps});
  system.rigid.controls = {{.name = "right", .unit = {}, .function = 3e4},
                           {.name = "left", .unit = {}, .function = 0.0}};
  VectorXd q[2];
  for (int k = 0; k < 2; ++k) {
    base::set_threads(k + 1);
    const auto model = test::make_model(system);
    q[k] = test::run(*model, test::tied_state(*model, 1.0, VectorXd::Zero(2)), {.dt = 1.0, .steps = 10}).state.q;
  }
  base::set_threads(1);
  EXPECT_TRUE(q[0] == q[1]);
  EXPECT_GT((q[0] - test::tied_state(*test::make_model(system), 1.0, VectorXd::Zero(2)).q).norm(), 0.1);
}

TEST(Ties, AMuscleMovesAClosedLoop) {
  test::TiedSystem system;
  system.rigid = test::four_bar({}, 0.0);
  system.rigid.controls = {{.name = "field", .unit = {}, .function = 0.0}};
  SolidDescription bar = test::muscle("bar", {.viscosity = 0.1}, 50.0, {0.0, 8.0});
  system.tie(bar, test::plane(2, 0.0), 0);
  system.tie(bar, test::plane(2, 8.0), 2);
  system.solids.push_back(bar);
  const auto model = test::make_model(system);
  const VectorXd w = test::admissible_rates(*test::make_model(system.rigid), 0, 1e-3);
  double drift = 0.0;
  const test::Run done =
      test::run(*model, test::tied_state(*model, 1.0, w), {.dt = 1.0, .steps = 40},
                [&](const auto& node) { drift = std::max(drift, model->manifold->violation(node.state.q)); });
  EXPECT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
  EXPECT_LT(drift, 1e-11);
  EXPECT_GT((done.state.x - model->manifold->reference()).norm(), 1e-3);
}

}  // namespace
}  // namespace muldi::fem
