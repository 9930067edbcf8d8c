/// Steady precession of the symmetric heavy top (numerics 3.7).
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi::variational {
namespace {

using Eigen::Vector3d;

constexpr double tilt = 30.0 * test::degree;
constexpr double spin = 1.0;  // rad/ms about its own axis, in all

/// The roots of J_3 w_3 Om - J_1 Om^2 cos(tilt) = m g l.
double precession(bool fast) {
  const double a = 4000.0 * std::cos(tilt);
  const double b = 800.0 * spin;
  const double c = 1.0 * 9.81e-3 * 50.0;
  const double root = std::sqrt(b * b - 4.0 * a * c);
  return fast ? (b + root) / (2.0 * a) : 2.0 * c / (b + root);
}

struct Motion {
  double tilt_error = 0.0;
  double rate = 0.0;  ///< mean rate of precession
};

Motion precess(double rate, double dt, long steps) {
  const auto model = test::make_model(test::heavy_top(tilt));
  const State rest = test::state_at_rest(*model);
  const Vector3d axis = rest.q.segment<3>(9);
  const Vector3d turning = rate * (Vector3d::UnitZ() - std::cos(tilt) * axis) + spin * axis;
  Motion result;
  double azimuth = 0.0;
  double before = 0.0;
  const test::Run done = test::run(
      *model, test::state_at(*model, rest.x, turning), {.dt = dt, .steps = steps}, [&](const NodeRecord& node) {
        const Vector3d d3 = node.state.q.segment<3>(9);
        const double across = std::hypot(d3.x(), d3.y());
        result.tilt_error = std::max(result.tilt_error, std::abs(std::atan2(across, d3.z()) - tilt));
        const double now = std::atan2(d3.y(), d3.x());
        azimuth += std::remainder(now - before, 2.0 * std::numbers::pi);
        before = now;
      });
  EXPECT_EQ(done.result.status, Status::completed);
  result.rate = azimuth / done.result.t;
  return result;
}

TEST(HeavyTop, RatesAreThoseOfTheTable) {
  EXPECT_NEAR(precession(false), 0.000614761492232, 1e-12 * 0.0006);
  EXPECT_NEAR(precession(true), 0.230325346183, 1e-12);
}

TEST(HeavyTop, KeepsItsTiltInSteadyPrecessionToSecondOrder) {
  for (const bool fast : {false, true}) {
    const double rate = precession(fast);
    const Motion coarse = precess(rate, 0.1, 3000);
    const Motion fine = precess(rate, 0.05, 6000);
    std::cout << (fast ? "fast" : "slow") << ": tilt error " << coarse.tilt_error << ", ratio "
              << coarse.tilt_error / fine.tilt_error << ", rate error " << coarse.rate / rate - 1.0 << '\n';
    EXPECT_NEAR(coarse.tilt_error / fine.tilt_error, 4.0, 0.2) << fast;
    // A turn of 0.1 rad a step: 0.1^2/8 of an angle is the size of a second-order error.
    EXPECT_LT(coarse.tilt_error, 0.01 / 8.0) << fast;
    EXPECT_LT(std::abs(coarse.rate / rate - 1.0), 0.01 / 8.0) << fast;
    EXPECT_NEAR(test::extrapolated(coarse.rate, fine.rate), rate, 1e-5 * rate) << fast;
  }
}

}  // namespace
}  // namespace muldi::variational
