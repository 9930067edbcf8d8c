/// Rigid bodies and mechanisms: closed forms of numerics 3.7, conserved quantities, loops, the energy ledger.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "base/text.hpp"
#include "scene_run.hpp"

namespace muldi::golden {
namespace {

/// Largest distance of a channel from its first row.
double drift(const SceneRun& run, const std::string& path) {
  const auto rows = run.rows(path);
  return (rows.colwise() - rows.col(0)).colwise().norm().maxCoeff();
}

/// Largest absolute value of a scalar channel in rows [begin, end).
double largest_in(const SceneRun& run, const std::string& path, Eigen::Index begin, Eigen::Index end) {
  return run.rows(path).row(0).segment(begin, end - begin).cwiseAbs().maxCoeff();
}

/// The polynomial through the rows [first, first + 8) of the first entry of a channel, at t.
double interpolated(const SceneRun& run, const std::string& path, Eigen::Index first, double t) {
  const auto times = run.rows("time");
  const auto values = run.rows(path);
  double sum = 0.0;
  for (Eigen::Index i = first; i < first + 8; ++i) {
    double weight = 1.0;
    for (Eigen::Index k = first; k < first + 8; ++k) {
      if (k != i) weight *= (t - times(0, k)) / (times(0, i) - times(0, k));
    }
    sum += weight * values(0, i);
  }
  return sum;
}

/// Time between the first and the third passage of the pendulum through the bottom.
double period(const SceneRun& run) {
  const std::string path = "joints/hinge/coordinate";
  const auto times = run.rows("time");
  const auto angle = run.rows(path);
  constexpr double bottom = -0.5 * std::numbers::pi;
  std::vector<double> passages;
  for (Eigen::Index i = 3; i + 4 < times.cols(); ++i) {
    if ((angle(0, i) - bottom) * (angle(0, i + 1) - bottom) > 0.0) continue;
    double early = times(0, i), late = times(0, i + 1);
    while (late - early > 1e-11) {
      const double middle = 0.5 * (early + late);
      const bool passed = (interpolated(run, path, i - 3, middle) - bottom) * (angle(0, i) - bottom) <= 0.0;
      (passed ? late : early) = middle;
    }
    passages.push_back(late);
  }
  return passages.at(2) - passages.at(0);
}

TEST(Pendulum, HasThePeriodOfTheEllipticIntegral) {
  const SceneRun coarse("pendulum");
  const double period5 = period(coarse), period2 = period(SceneRun("pendulum", {"dynamics.step=2.5 ms"})),
               period1 = period(SceneRun("pendulum", {"dynamics.step=1.25 ms"}));
  // The same scheme at these steps in an independent program, four digits after the point (numerics 3.7).
  EXPECT_NEAR(period5, 1106.0953, 3e-4);
  EXPECT_NEAR(period2, 1106.2285, 1e-4);
  const double limit = (16.0 * extrapolated(period2, period1) - extrapolated(period5, period2)) / 15.0;
  EXPECT_NEAR(limit, 1106.27291017, 1e-6);
  EXPECT_NEAR(drift(coarse, "energy/total"), 0.00761, 5e-6);
}

TEST(DoublePendulum, KeepsItsEnergyBandWhateverItsPath) {
  const SceneRun coarse("double_pendulum", {"dynamics.duration=10 s"});
  const SceneRun fine("double_pendulum", {"dynamics={duration: 10 s, step: 0.5 ms}", "record.every=10"});
  EXPECT_LT(coarse.rows("solver/constraint_violation").maxCoeff(), 1e-13);
  const double swing = drift(coarse, "energy/kinetic");
  EXPECT_LT(drift(coarse, "energy/total"), 1e-3 * swing);
  // Other paths after some seconds: the bands are comparable, not four to one.
  EXPECT_LT(drift(fine, "energy/total"), 0.5 * drift(coarse, "energy/total"));
}

TEST(HeavyTop, KeepsItsTiltInSteadyPrecession) {
  const auto tilt_error = [](const SceneRun& run) {
    const auto axes = run.rows("bodies/top/orientation");
    double worst = 0.0;
    for (Eigen::Index i = 0; i < axes.cols(); ++i) {
      worst = std::max(worst, std::abs(std::acos(axes(8, i)) - 30.0 * degree));
    }
    return worst;
  };
  const SceneRun coarse("heavy_top"), fine("heavy_top", {"dynamics.step=0.025 ms", "record.every=40"});
  EXPECT_LT(tilt_error(coarse), 1e-5);
  EXPECT_NEAR(tilt_error(coarse) / tilt_error(fine), 4.0, 0.2);
}

TEST(HeavyTop, PrecessesAtTheRateOfTheClosedForm) {
  const auto angle = [](const SceneRun& run) {
    const Eigen::VectorXd axes = run.last("bodies/top/orientation");
    return std::atan2(axes[5], axes[2]);
  };
  const double limit =
      extrapolated(angle(SceneRun("heavy_top")), angle(SceneRun("heavy_top", {"dynamics.step=0.025 ms"})));
  EXPECT_NEAR(limit / 200.0, 0.000614761492232, 1e-10);
}

TEST(FreeBody, KeepsItsMomentaAndItsEnergyToRoundOff) {
  // The scheme is that of Moser and Veselov for a free body, which keeps momentum and energy exactly (McLachlan and
  // Zanna, The discrete Moser-Veselov algorithm for the free rigid body, revisited, 2005).
  const SceneRun run("free_body");
  for (const char* path : {"momentum/linear", "momentum/angular", "energy/total"}) {
    EXPECT_LT(drift(run, path), 1e-12 * run.last(path).norm()) << path;
  }
  // It tumbles: the middle axis turns over.
  EXPECT_LT(run.rows("bodies/plate/orientation").row(4).minCoeff(), -0.9);
}

TEST(FreeTree, KeepsItsMomentaAndAnEnergyBand) {
  const SceneRun run("tree"), fine("tree", {"dynamics.step=0.5 ms", "record.every=2"});
  for (const char* path : {"momentum/linear", "momentum/angular"}) {
    EXPECT_LT(drift(run, path), 1e-11 * run.last(path).norm()) << path;
  }
  EXPECT_NEAR(drift(run, "energy/total") / drift(fine, "energy/total"), 4.0, 0.2);
}

TEST(FourBar, StaysClosedAndKeepsItsEnergyBandOverTenSeconds) {
  const SceneRun run("four_bar", {"dynamics.duration=10 s", "record.every=1",
                                  "record.points=[crank.a, crank.b, coupler.b, coupler.c, rocker.c, rocker.d]"});
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const auto gap = [&](const std::string& a, const std::string& b) {
    return (run.rows("points/" + a) - run.rows("points/" + b)).colwise().norm().maxCoeff();
  };
  EXPECT_LT(gap("crank.b", "coupler.b"), 1e-11);
  EXPECT_LT(gap("coupler.c", "rocker.c"), 1e-11);
  EXPECT_LT(run.rows("points/crank.a").colwise().norm().maxCoeff(), 1e-11);
  const auto d = run.rows("points/rocker.d");
  EXPECT_LT((d.colwise() - Eigen::Vector3d(110.0, 0.0, 0.0)).colwise().norm().maxCoeff(), 1e-11);
  const Eigen::Index n = static_cast<Eigen::Index>(run.n_rows("time"));
  const double first = largest_in(run, "energy/balance", 0, n / 10);
  const double last = largest_in(run, "energy/balance", n - n / 10, n);
  EXPECT_LE(last, 1.1 * first);
  // It turns through: many revolutions of the crank, one direction.
  EXPECT_GT(run.value("joints/A/coordinate"), 20.0 * std::numbers::pi);
}

TEST(FourBar, EnergyBandFallsWithTheSquareOfTheStep) {
  const SceneRun coarse("four_bar"), fine("four_bar", {"dynamics.step=0.5 ms", "record.every=4"});
  const double ratio = drift(coarse, "energy/total") / drift(fine, "energy/total");
  EXPECT_NEAR(ratio, 4.0, 0.2);
}

TEST(FourBar, MeetsNoChangePointOnATurntable) {
  // The plane of the loop turns through a quarter and more: the constraints that are redundant must turn with it.
  const std::string turn =
      "joints.turn={type: revolute, axis: [0, 1, 0], from: {body: ground, at: [0, 0, 0]}, "
      "to: {body: table, at: [0, 0, 0]}}";
  const SceneRun run("four_bar", {"bodies.table={mass: 1000, inertia: [1.0e+6, 1.0e+6, 1.0e+6], position: [0, 0, 0]}",
                                  turn, "joints.A.from.body=table", "joints.D.from.body=table",
                                  "initial.joints={A: {velocity: 0.02}, turn: {velocity: 0.004}}",
                                  "record.points=[coupler.c, rocker.c]"});
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  EXPECT_GT(run.value("joints/turn/coordinate"), std::numbers::pi);
  EXPECT_THAT(run.warnings(), testing::IsEmpty());
  EXPECT_LT((run.rows("points/coupler.c") - run.rows("points/rocker.c")).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(SliderCrank, BalanceOfWorkAndEnergyFallsWithTheSquareOfTheStep) {
  double before = 0.0;
  for (const double step : {1.0, 0.5, 0.25}) {
    const SceneRun run("slider_crank", {step_of(step), base::format("record.every={}", static_cast<int>(2 / step))});
    ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
    const double worst = drift(run, "energy/balance");
    if (before > 0.0) {
      EXPECT_NEAR(before / worst, 4.0, 0.2);
    }
    before = worst;
  }
}

}  // namespace
}  // namespace muldi::golden
