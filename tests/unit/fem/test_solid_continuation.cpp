/// Arc length with finite elements: pull-in is passed and located, by every kind of control; derivatives by the load.
#include <gtest/gtest.h>

#include <cmath>

#include "statics/sweep.hpp"
#include "support/solid_system.hpp"

namespace muldi::fem {
namespace {

using Eigen::VectorXd;
using statics::CriticalPoint;
using statics::Stability;
using statics::SweepResult;

constexpr double permittivity = 3.7 * test::eps0_si;
constexpr double mu = 0.7 / 3;
constexpr double critical_field = 58009.6395041;  // numerics 3.1
const double critical_stretch = std::pow(4.0, -1.0 / 3.0);

Material ideal(Formulation formulation) {
  Material material = test::rubber(mu, 10.0, formulation);
  material.electric = IdealDielectric{.permittivity = permittivity};
  return material;
}

/// One cell with symmetry planes, exactly incompressible; control 0 is the voltage across z = 1 mm.
test::SolidSystem one_cell() {
  test::SolidSystem system = test::solid_box({1, 1, 1}, {0, 0, 0}, {1, 1, 1});
  system.hold_lower_faces();
  system.set_potential(test::plane(2, 0.0), {});
  system.set_potential(test::plane(2, 1.0), system.control(0.0));
  system.fill(ideal(Formulation::incompressible), mu, Formulation::incompressible);
  return system;
}

struct Curve {
  SweepResult result;
  std::vector<double> loads;
  std::vector<double> stretches;
  std::vector<bool> stable;
  std::vector<statics::StaticState> states;
};

Curve follow(const test::SolidSystem& system, const statics::SweepOptions& options) {
  const auto model = test::make_model(system);
  statics::StaticState state = test::static_start(*model);
  statics::Sweep sweep(*model, {0.0}, {1.0}, options);
  Curve curve;
  const int corner = system.node_at({1, 1, 1});
  curve.result = sweep.run(state, {.record = [&](const statics::SweepPoint& at) {
                             curve.loads.push_back(at.load);
                             curve.stretches.push_back(at.q[3 * corner + 2]);
                             curve.stable.push_back(at.report.stability == Stability::stable);
                             curve.states.push_back(at.state);
                           }});
  return curve;
}

Curve pull_in() {
  return follow(one_cell(), {.from = 0.0, .to = 6e4, .steps = 30, .continuation = statics::Continuation::arc_length});
}

TEST(SolidContinuation, PassesPullInAndFollowsTheUnstableBranch) {
  const Curve curve = pull_in();
  std::size_t unstable = 0;
  double least = 1.0;
  for (std::size_t k = 0; k < curve.loads.size(); ++k) {
    const double L = curve.stretches[k];
    // Lambda^4 - Lambda + eps E^2/mu = 0 (numerics 3.1).
    ASSERT_NEAR(std::pow(L, 4) - L + permittivity * curve.loads[k] * curve.loads[k] / mu, 0.0, 1e-10);
    ASSERT_EQ(curve.stable[k], L > critical_stretch) << L;
    unstable += curve.stable[k] ? 0 : 1;
    least = std::min(least, L);
  }
  EXPECT_GT(unstable, 10U);
  EXPECT_LT(least, 0.2);
}

TEST(SolidContinuation, LocatesTheLimitPoint) {
  const Curve curve = pull_in();
  ASSERT_EQ(curve.result.critical.size(), 1U);
  EXPECT_EQ(curve.result.critical[0].kind, CriticalPoint::Kind::limit);
  EXPECT_NEAR(curve.result.critical[0].load, critical_field, 1e-8 * critical_field);  // asked for: 1e-6
}

TEST(SolidContinuation, MeetsTheTableOfTheUnstableBranch) {
  const Curve curve = pull_in();
  const test::SolidSystem system = one_cell();
  const auto model = test::make_model(system);
  const int corner = system.node_at({1, 1, 1});
  // Numerics 3.1: field, unstable stretch.
  for (const auto& [field, stretch] : {std::pair(5e4, 0.369683313576), std::pair(4e4, 0.22731364612)}) {
    std::size_t nearest = 0;
    for (std::size_t k = 0; k < curve.loads.size(); ++k) {
      if (std::abs(curve.stretches[k] - stretch) < std::abs(curve.stretches[nearest] - stretch)) nearest = k;
    }
    statics::StaticState state = curve.states[nearest];
    statics::EquilibriumSolver solver(*model, {.tolerance = 1e-12});
    const statics::EquilibriumReport report = solver.solve(state, std::vector<double>{field});
    ASSERT_TRUE(report.converged) << report.inadmissible;
    EXPECT_EQ(report.stability, Stability::unstable);
    EXPECT_NEAR(state.q[3 * corner + 2], stretch, 1e-11);
  }
}

/// A cube whose every row depends on the control: displacements, a potential, a floating charge, surface charge,
/// traction, pressure.
test::SolidSystem driven(Formulation formulation) {
  test::SolidSystem system = test::solid_of(test::cube_of(2));
  const Value value = system.control(0.0);
  system.hold_lower_faces();
  system.hold([](const Eigen::Vector3d& X) { return X[0] > 1 - 1e-9 && X[1] < 0.6; }, 0, value);
  system.set_potential(test::plane(2, 0.0), {});
  system.set_potential([](const Eigen::Vector3d& X) { return X[2] > 1 - 1e-9 && X[0] < 0.4; }, value);
  const std::vector<int> top = system.nodes(test::plane(2, 1.0));
  system.solid.dead_loads.push_back({.nodes = {top[4]}, .unit = {{1, 2, -1}}, .value = value});
  system.solid.surface_charges.push_back({.nodes = {top.back()}, .unit = {1e-7}, .value = value});
  system.fill(ideal(formulation), mu, formulation);
  return system;
}

TEST(SolidContinuation, TheLoadRateIsTheDerivativeOfTheRows) {
  for (const Formulation formulation : test::formulations) {
    const test::SolidSystem system = driven(formulation);
    const auto model = test::make_model(system);
    const Solid& solid = test::solid_in(*model);
    const statics::StaticState start = test::static_start(*model);
    const auto rows_at = [&](double load, VectorXd& rate) {
      VectorXd q = start.q;
      VectorXd y = start.y;
      for (Eigen::Index i = 0; i < q.size(); ++i) q[i] += 0.01 * std::sin(3.0 * static_cast<double>(i));
      for (Eigen::Index i = 0; i < y.size(); ++i) y[i] += 0.02 * std::cos(2.0 * static_cast<double>(i));
      if (solid.n_potentials() > 0) y.head(solid.n_potentials()) *= 1e5;
      const std::vector<double> u{load};
      solid.place({.u = u, .u_end = u}, q, y);
      const VectorXd zero = VectorXd::Zero(model->n_q());
      const model::IntervalPoint at{.q0 = q, .q1 = q, .q = q, .v = zero, .u = u, .y = &y};
      model::IntervalForces forces{.force = zero, .momentum = zero, .begin = zero, .end = zero, .stage = y};
      model->forces(at, forces);
      VectorXd both(q.size() + y.size());
      both << forces.force, forces.stage;
      VectorXd rows = VectorXd::Zero(q.size());
      VectorXd h = VectorXd::Zero(y.size());
      solid.add_load_rate(at, std::vector<double>{1.0}, rows, h);
      rate.resize(both.size());
      rate << rows, h;
      return both;
    };
    VectorXd rate, unused;
    const double h = 1e-3;
    const double at = 0.05;
    rows_at(at, rate);
    const VectorXd difference = (8.0 * (rows_at(at + h, unused) - rows_at(at - h, unused)) -
                                 (rows_at(at + 2 * h, unused) - rows_at(at - 2 * h, unused))) /
                                (12.0 * h);
    EXPECT_LT((difference.head(model->n_q()) - rate.head(model->n_q())).lpNorm<Eigen::Infinity>(),
              1e-8 * rate.head(model->n_q()).lpNorm<Eigen::Infinity>());
    const Eigen::Index n_phi = solid.n_potentials();
    const VectorXd charges = rate.segment(model->n_q(), n_phi);
    EXPECT_LT((difference.segment(model->n_q(), n_phi) - charges).lpNorm<Eigen::Infinity>(),
              1e-8 * charges.lpNorm<Eigen::Infinity>());
    if (solid.n_pressures() == 0 || formulation == Formulation::mean_dilatation) continue;
    const VectorXd volumes = rate.tail(solid.n_pressures());
    EXPECT_LT((difference.tail(solid.n_pressures()) - volumes).lpNorm<Eigen::Infinity>(),
              1e-8 * volumes.lpNorm<Eigen::Infinity>());
  }
}

TEST(SolidContinuation, FollowsDisplacementsAndForcesToTheSameCurve) {
  // A bar shortened by its end, or pushed by a dead load: the same stretches and forces (neo-Hookean, incompressible:
  // P = mu (L - 1/L^2), numerics 3.4).
  test::SolidSystem by_displacement = test::solid_box({1, 1, 1}, {0, 0, 0}, {1, 1, 1});
  by_displacement.hold_lower_faces();
  by_displacement.hold(test::plane(2, 1.0), 2, by_displacement.control(0.0));
  by_displacement.fill(test::rubber(mu, 0.0, Formulation::incompressible), mu, Formulation::incompressible);
  const Curve moved =
      follow(by_displacement, {.from = 0.0, .to = -0.3, .steps = 6, .continuation = statics::Continuation::arc_length});
  ASSERT_EQ(moved.result.end, SweepResult::End::completed) << moved.result.sentence;
  EXPECT_EQ(moved.loads.back(), -0.3);
  EXPECT_NEAR(moved.stretches.back(), 0.7, 1e-15);
  EXPECT_TRUE(moved.result.critical.empty());

  test::SolidSystem by_force = test::solid_box({1, 1, 1}, {0, 0, 0}, {1, 1, 1});
  by_force.hold_lower_faces();
  DeadLoad top{.nodes = by_force.nodes(test::plane(2, 1.0)), .unit = {}, .value = by_force.control(0.0)};
  top.unit.assign(4, {0, 0, 0.25});
  by_force.solid.dead_loads.push_back(top);
  by_force.fill(test::rubber(mu, 0.0, Formulation::incompressible), mu, Formulation::incompressible);
  const Curve pushed =
      follow(by_force, {.from = 0.0, .to = -0.3, .steps = 6, .continuation = statics::Continuation::arc_length});
  ASSERT_EQ(pushed.result.end, SweepResult::End::completed) << pushed.result.sentence;
  for (std::size_t k = 0; k < pushed.loads.size(); ++k) {
    const double L = pushed.stretches[k];
    EXPECT_NEAR(mu * (L - 1.0 / (L * L)), pushed.loads[k], 1e-10);
  }
}

TEST(SolidContinuation, FindsWhereAnotherBranchCrosses) {
  // Rivlin's cube: equal dead tensions P on all faces leave an incompressible neo-Hookean cube a cube; with
  // W = mu/2 (a^2 + b^2 + c^2), abc = 1, the second variation of W - P (a + b + c) changes its sign at P = 2 mu.
  test::SolidSystem system = test::solid_box({1, 1, 1}, {0, 0, 0}, {1, 1, 1});
  system.hold_lower_faces();
  const Value value = system.control(0.0);
  for (int i = 0; i < 3; ++i) {
    DeadLoad side{.nodes = system.nodes(test::plane(i, 1.0)), .unit = {}, .value = value};
    side.unit.assign(4, 0.25 * Eigen::Vector3d::Unit(i));
    system.solid.dead_loads.push_back(side);
  }
  system.fill(test::rubber(mu, 0.0, Formulation::incompressible), mu, Formulation::incompressible);
  const Curve curve =
      follow(system, {.from = 0.0, .to = 0.7, .steps = 10, .continuation = statics::Continuation::arc_length});
  ASSERT_EQ(curve.result.end, SweepResult::End::completed) << curve.result.sentence;
  ASSERT_EQ(curve.result.critical.size(), 1U);
  EXPECT_EQ(curve.result.critical[0].kind, CriticalPoint::Kind::branch);
  EXPECT_NEAR(curve.result.critical[0].load, 2.0 * mu, 1e-6);
  for (std::size_t k = 0; k < curve.loads.size(); ++k) {
    EXPECT_NEAR(curve.stretches[k], 1.0, 1e-12);
    EXPECT_EQ(curve.stable[k], curve.loads[k] < 2.0 * mu);
  }
}

}  // namespace
}  // namespace muldi::fem
