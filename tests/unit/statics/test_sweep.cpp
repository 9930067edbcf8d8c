/// Load curves: pull-in is bracketed, the unstable branch is followed, what
/// cannot be swept is said.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "statics/sweep.hpp"
#include "support/systems.hpp"

namespace muldi::statics {
namespace {

using Eigen::VectorXd;
using End = SweepResult::End;

/// numerics 3.1, mu 0.7/3 and eps_r 3.7.
constexpr double pull_in_field = 58009.6395041;

struct Curve {
  SweepResult result;
  std::vector<double> loads;
  std::vector<double> lengths;
  std::vector<Stability> stability;
};

Curve sweep(const model::Model& model, const SweepOptions& options) {
  Curve curve;
  StaticState state{model.manifold->reference(), VectorXd::Zero(model.manifold->n_loop_rows())};
  std::vector<double> fixed(model.controls.size(), 0.0);
  std::vector<double> direction(model.controls.size(), 0.0);
  if (!direction.empty()) direction[0] = 1.0;
  Sweep sweep(model, fixed, direction, options);
  curve.result = sweep.run(state, {.record = [&](const SweepPoint& point) {
                             curve.loads.push_back(point.load);
                             curve.lengths.push_back(point.q[point.q.size() - 1]);
                             curve.stability.push_back(point.report.stability);
                           }});
  return curve;
}

TEST(Sweep, RecordsEveryStepOfAStableCurve) {
  const auto model = test::make_model(test::membrane(0.0, 0.0));
  const Curve curve = sweep(*model, {.from = 0.0, .to = 5e4, .steps = 5});
  EXPECT_EQ(curve.result.end, End::completed);
  EXPECT_EQ(curve.loads, (std::vector<double>{0.0, 1e4, 2e4, 3e4, 4e4, 5e4}));
  const std::vector<double> table{1.0, 0.995275419992, 0.980531432033, 0.953727609917, 0.909804644007, 0.833389955634};
  for (std::size_t k = 0; k < table.size(); ++k) EXPECT_NEAR(curve.lengths[k], table[k], 1e-11);
  EXPECT_EQ(curve.result.last_good, 5e4);
}

TEST(Sweep, BracketsPullIn) {
  const auto model = test::make_model(test::membrane(0.0, 0.0));
  const Curve curve = sweep(*model, {.from = 0.0, .to = 7e4, .steps = 7});
  EXPECT_EQ(curve.result.end, End::loss_of_equilibrium);
  EXPECT_LE(curve.result.last_good, pull_in_field);
  EXPECT_GE(curve.result.first_bad, pull_in_field);
  EXPECT_LT(curve.result.first_bad - curve.result.last_good, 1e-3 * pull_in_field) << "0.1 % (numerics 3.1)";
  EXPECT_NEAR(curve.result.last_good, pull_in_field, 1e-5 * pull_in_field);
  EXPECT_EQ(curve.result.sentence.substr(0, 45), "the equilibrium is lost at a load between 580");
  for (const double length : curve.lengths) EXPECT_GT(length, std::pow(4.0, -1.0 / 3.0)) << "no finite garbage";
}

TEST(Sweep, BracketsPullInFromAbove) {
  // A field of the other sign pulls in as well.
  const auto model = test::make_model(test::membrane(0.0, 0.0));
  const Curve curve = sweep(*model, {.from = 0.0, .to = -7e4, .steps = 9});
  EXPECT_EQ(curve.result.end, End::loss_of_equilibrium);
  EXPECT_NEAR(curve.result.last_good, -pull_in_field, 1e-5 * pull_in_field);
}

TEST(Sweep, FollowsTheUnstableBranchPastTheLimitPoint) {
  const auto model = test::make_model(test::membrane(0.0, 0.0));
  const Curve curve = sweep(*model, {.from = 0.0, .to = 7e4, .steps = 200, .continuation = Continuation::arc_length});
  // The curve turns back at 4^(-1/3) and E*, and ends where the model ends:
  // stretch 0.2.
  const auto top = std::max_element(curve.loads.begin(), curve.loads.end());
  const auto at_top = static_cast<std::size_t>(top - curve.loads.begin());
  // Points 1/200 of the range apart: the parabola at the top is flat to 1e-4.
  EXPECT_NEAR(*top, pull_in_field, 1e-4 * pull_in_field);
  EXPECT_NEAR(curve.lengths[at_top], std::pow(4.0, -1.0 / 3.0), 6e-3);
  for (std::size_t k = 0; k < curve.loads.size(); ++k) {
    const double L = curve.lengths[k];
    // Every point is an equilibrium: L^4 - L + beta = 0.
    const double beta = 3.7 * test::eps0 * curve.loads[k] * curve.loads[k] / (0.7 / 3.0);
    ASSERT_NEAR(std::pow(L, 4) - L + beta, 0.0, 1e-11);
    const bool clear = std::abs(L - std::pow(4.0, -1.0 / 3.0)) > 1e-6;
    if (clear) {
      ASSERT_EQ(curve.stability[k] == Stability::stable, L > std::pow(4.0, -1.0 / 3.0)) << L;
    }
  }
  EXPECT_LT(curve.lengths.back(), 0.21);
  EXPECT_GE(curve.lengths.back(), 0.2);
}

TEST(Sweep, ReachesTheTabulatedUnstableStretch) {
  // Along the arc between 5 kV/mm stations: numerics 3.1, mu 0.7/3:
  // 0.369683313576 at 50, 0.22731364612 at 40 kV/mm.
  const auto model = test::make_model(test::membrane(0.0, 0.0));
  for (const auto& [field, stretch] : {std::pair(5e4, 0.369683313576), std::pair(4e4, 0.22731364612)}) {
    StaticState state{VectorXd::Constant(1, stretch + 1e-3), VectorXd()};
    EquilibriumSolver solver(*model, {});
    const std::vector<double> u{field};
    // Plain Newton on the tangent converges to the near equilibrium even where
    // it is unstable.
    for (int n = 0; n < 8; ++n) {
      solver.linearise(state, u);
      state.x[0] += solver.residual()[0] / solver.tangent()(0, 0);
    }
    EXPECT_NEAR(state.x[0], stretch, 1e-11);
    solver.linearise(state, u);
    EXPECT_EQ(solver.stability(), Stability::unstable);
  }
}

TEST(Sweep, ArcLengthAndLoadStepsAgreeOnStableCurves) {
  const auto model = test::make_model(test::muscle_joint(0.0));
  const Curve natural = sweep(*model, {.from = 0.0, .to = 3e4, .steps = 10});
  const Curve arc = sweep(*model, {.from = 0.0, .to = 3e4, .steps = 10, .continuation = Continuation::arc_length});
  EXPECT_EQ(natural.result.end, End::completed);
  EXPECT_EQ(arc.result.end, End::completed);
  EXPECT_EQ(arc.loads.back(), 3e4);
  StaticState state{model->manifold->reference(), VectorXd()};
  EquilibriumSolver solver(*model, {});
  const std::vector<double> u{3e4, 0.0};
  ASSERT_TRUE(solver.solve(state, u).converged);
  EXPECT_NEAR(std::abs(state.x[0]) / test::degree, 7.7284947404, 1e-10);
}

TEST(Sweep, RefusesASystemThatMovesWithoutForce) {
  const auto model = test::make_model(test::pendulum(0.0));
  const Curve curve = sweep(*model, {.from = 0.0, .to = 1.0, .steps = 2});
  EXPECT_EQ(curve.result.end, End::free_motion);
  EXPECT_EQ(curve.result.sentence,
            "the system can move without any force: hold it by joints, springs "
            "or muscles before asking for its "
            "equilibrium");
  EXPECT_TRUE(curve.loads.empty()) << "nothing is recorded as if it were valid";
}

TEST(Sweep, SaysThatTheFirstLoadIsTooMuch) {
  const auto model = test::make_model(test::membrane(0.0, 0.0));
  const Curve curve = sweep(*model, {.from = 7e4, .to = 8e4, .steps = 2});
  EXPECT_EQ(curve.result.end, End::loss_of_equilibrium);
  EXPECT_FALSE(curve.result.sentence.empty());
  EXPECT_TRUE(curve.loads.empty());
}

TEST(Sweep, StopsWhereTheUserInterrupts) {
  const auto model = test::make_model(test::membrane(0.0, 0.0));
  for (const Continuation continuation : {Continuation::natural, Continuation::arc_length}) {
    StaticState state{model->manifold->reference(), VectorXd()};
    int points = 0;
    Sweep sweep(*model, {0.0}, {1.0}, {.from = 0.0, .to = 5e4, .steps = 50, .continuation = continuation});
    const SweepResult result =
        sweep.run(state, {.record = [&](const SweepPoint&) { ++points; }, .interrupted = [&] { return points == 3; }});
    EXPECT_EQ(result.end, End::interrupted);
    EXPECT_EQ(points, 3);
  }
}

}  // namespace
}  // namespace muldi::statics
