/// The explicit variant of the integrator (thesis 4.3.2): order, energy, stable step, restart.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "support/solid_system.hpp"
#include "support/trajectory.hpp"
#include "variational/explicit_stepper.hpp"

namespace muldi::fem {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using variational::Integrator;

constexpr double mu = 0.233;
constexpr double lambda = 10.0;
constexpr double density = 1e-3;

/// A cube on three symmetry planes between electrodes of which one covers a part of the top; it shears under way.
test::SolidSystem cube(base::TimeFunction voltage) {
  test::SolidSystem system = test::solid_of(test::cube_of(2));
  system.hold_lower_faces();
  system.set_potential(test::plane(2, 0.0), {});
  const Value value = system.control(std::move(voltage));
  system.set_potential([](const Vector3d& X) { return X[2] > 1 - 1e-9 && X[0] < 0.4; }, value);
  Material material = test::rubber(mu, lambda, Formulation::displacement);
  material.electric = IdealDielectric{.permittivity = 3.7 * test::eps0_si};
  system.fill(material, mu, Formulation::displacement);
  return system;
}

VectorXd smooth_velocity(const test::SolidSystem& system) {
  VectorXd v(system.solid.X.size());
  for (int n = 0; n < system.n_nodes(); ++n) {
    const Vector3d X = system.node(n);
    v.segment<3>(3 * n) = Vector3d(0.6 * X[0], -0.4 * X[1] * X[2], -0.8 * X[2]);
  }
  return v;
}

struct Ended {
  VectorXd q;
  VectorXd p;
  double band = 0.0;  ///< max |H - H0|
  double kinetic = 0.0;
};

Ended run(Integrator integrator, double dt, long steps) {
  const test::SolidSystem system = cube(1.5e4);
  const auto model = test::make_model(system);
  variational::State state = test::moving_state(*model, dt, smooth_velocity(system));
  variational::Ledger ledger;
  variational::StepReport last;
  variational::TimeLoop loop(*model,
                             {.dt = dt, .steps = steps, .step = {.tolerance = 1e-12}, .integrator = integrator});
  Ended ended;
  double H0 = 0.0;
  const auto result = loop.run(state, ledger, last, {.record = [&](const variational::NodeRecord& node) {
                                 const double H = node.values.total.kinetic + node.values.total.potential();
                                 if (node.step == 0) H0 = H;
                                 ended.band = std::max(ended.band, std::abs(H - H0));
                                 ended.kinetic = std::max(ended.kinetic, node.values.total.kinetic);
                                 ended.p = node.values.momentum;
                               }});
  EXPECT_EQ(result.status, variational::Status::completed) << result.sentence;
  ended.q = state.q;
  return ended;
}

TEST(ExplicitIntegrator, HasOrderTwoAndTendsToTheMidpointRule) {
  const double dt = 2.5e-4;
  Ended at[3];
  for (int k = 0; k < 3; ++k) at[k] = run(Integrator::explicit_scheme, dt / (1 << k), 240L << k);
  const double of_q = std::log2((at[0].q - at[1].q).norm() / (at[1].q - at[2].q).norm());
  const double of_p = std::log2((at[0].p - at[1].p).norm() / (at[1].p - at[2].p).norm());
  std::cout << "orders: " << of_q << ", " << of_p << "; bands " << at[0].band / at[0].kinetic << ", "
            << at[1].band / at[1].kinetic << '\n';
  EXPECT_NEAR(of_q, 2.0, 0.05);
  EXPECT_NEAR(of_p, 2.0, 0.05);
  EXPECT_NEAR(at[1].band / at[2].band, 4.0, 0.2);
  EXPECT_LT(at[2].band, 1e-4 * at[2].kinetic);
  const auto limit = [](const VectorXd& coarse, const VectorXd& fine) { return VectorXd((4.0 * fine - coarse) / 3.0); };
  const Ended coarse = run(Integrator::midpoint, dt / 2, 480);
  const Ended fine = run(Integrator::midpoint, dt / 4, 960);
  // Both Richardson limits are of fourth order.
  const double apart = (limit(coarse.q, fine.q) - limit(at[1].q, at[2].q)).lpNorm<Eigen::Infinity>();
  std::cout << "limits apart by " << apart << '\n';
  EXPECT_LT(apart, 0.05 * (fine.q - at[2].q).lpNorm<Eigen::Infinity>());
  EXPECT_GT((fine.q - at[2].q).lpNorm<Eigen::Infinity>(), 0.0);
}

TEST(ExplicitIntegrator, KeepsItsEnergyInABand) {
  const double dt = 2e-3;
  const Ended early = run(Integrator::explicit_scheme, dt, 500);
  const Ended late = run(Integrator::explicit_scheme, dt, 4000);
  EXPECT_LT(late.band, 1.5 * early.band);
  EXPECT_LT(late.band, 0.05 * late.kinetic);
}

/// A column of n cells of side h whose nodes move along z only, both ends held.
test::SolidSystem column(int n, double h) {
  test::SolidSystem system = test::solid_box({1, 1, n}, {0, 0, 0}, {h, h, n * h});
  const auto everywhere = [](const Vector3d&) { return true; };
  for (int i = 0; i < 2; ++i) system.hold(everywhere, i);
  for (const double end : {0.0, n * h}) system.hold(test::plane(2, end), 2);
  system.fill(test::rubber(mu, lambda, Formulation::displacement), mu, Formulation::displacement);
  return system;
}

TEST(ExplicitIntegrator, KnowsTheStableStep) {
  // With consistent mass omega^2 = sum_i c_i^2 s(k_i), s(k) = 6 (1 - cos kh)/(h^2 (2 + cos kh)), c_P along z and c_S
  // across (trilinear elements are tensor products); the shortest waves have kh = pi across and (n - 1) pi/n along.
  const int n = 6;
  const double h = 0.5;
  const auto model = test::make_model(column(n, h));
  const auto s = [h](double kh) { return 6.0 * (1.0 - std::cos(kh)) / (h * h * (2.0 + std::cos(kh))); };
  const double pi = std::numbers::pi;
  const double omega = std::sqrt((lambda + 2.0 * mu) / density * s((n - 1) * pi / n) + 2.0 * mu / density * s(pi));
  const variational::State state = test::moving_state(*model, 1e-3);
  EXPECT_NEAR(variational::ExplicitStepper(*model, 1e-3).stable_step(state, {}), 2.0 / omega, 2e-3 * 2.0 / omega);

  variational::State slow = state;
  EXPECT_EQ(variational::ExplicitStepper(*model, 0.99 * 2.0 / omega).advance(slow, {}).status,
            variational::Status::running);
  variational::State fast = state;
  const variational::StepReport report = variational::ExplicitStepper(*model, 1.01 * 2.0 / omega).advance(fast, {});
  EXPECT_EQ(report.status, variational::Status::step_too_large);
  EXPECT_EQ(report.sentence,
            "the explicit integrator is stable for steps below 0.003029 (2/omega of the fastest wave in the mesh), the "
            "step is 0.00306: use a smaller one, or integrator: midpoint");
  EXPECT_EQ(fast.step, 0);
}

TEST(ExplicitIntegrator, TheStableStepIsWhereMotionBlowsUp) {
  const test::SolidSystem system = cube(1.5e4);
  const auto model = test::make_model(system);
  const variational::State start = test::moving_state(*model, 1e-3, smooth_velocity(system));
  const double stable = variational::ExplicitStepper(*model, 1e-3).stable_step(start, std::vector<double>{1.5e4});
  // The stiffness changes under way: a tenth below is stable.
  EXPECT_LT(run(Integrator::explicit_scheme, 0.9 * stable, 1500).band, 0.5);
}

TEST(ExplicitIntegrator, GoesOnFromACheckpointBitForBit) {
  // The voltage jumps under way, so that potentials are solved twice at a node.
  const test::SolidSystem system = cube(base::TimeFunction(base::Samples{.times = {0.0, 0.1}, .values = {1e4, 1.6e4}}));
  const variational::LoopOptions options{
      .dt = 2e-3, .steps = 120, .record_every = 30, .integrator = Integrator::explicit_scheme};
  for (const long stop : {30L, 60L}) {
    const auto model = test::make_model(system);
    variational::State state = test::moving_state(*model, options.dt, smooth_velocity(system));
    variational::State saved;
    variational::Ledger ledger, saved_ledger;
    variational::StepReport last, saved_last;
    VectorXd memory(test::solid_in(*model).n_memory());
    variational::TimeLoop(*model, options)
        .run(state, ledger, last,
             {.record = {},
              .checkpoint = [&](const variational::State& at, const variational::Ledger& l,
                                const variational::StepReport& r) {
                if (at.step != stop) return;
                saved = at;
                saved_ledger = l;
                saved_last = r;
                test::solid_in(*model).store_memory(memory);
              }});
    const auto again = test::make_model(system);
    test::solid_in(*again).restore_memory(memory);
    variational::TimeLoop(*again, options).run(saved, saved_ledger, saved_last, {});
    EXPECT_TRUE(saved.q == state.q);
    EXPECT_TRUE(saved.p == state.p);
    EXPECT_EQ(saved_ledger.source, ledger.source);
    EXPECT_EQ(state.step, 120);
  }
}

}  // namespace
}  // namespace muldi::fem
