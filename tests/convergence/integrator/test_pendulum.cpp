/// The pendulum of thesis Table 5.1 against its closed form (numerics 3.7).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi::variational {
namespace {

using std::numbers::pi;

/// T/T0 = 2/pi K(k), k = sin(release/2), by the arithmetic-geometric mean: K = pi/(2 agm(1, cos(release/2))).
double period_ratio(double release) {
  double a = 1.0;
  double b = std::cos(0.5 * release);
  for (int k = 0; k < 8; ++k) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 1.0 / a;
}

/// T0 = 2 pi sqrt(J_O/(m g l)), J_O = 3.17e5 + 40 46^2 g mm^2.
double small_period() { return 2.0 * pi * std::sqrt((3.17e5 + 40.0 * 46.0 * 46.0) / (40.0 * 9.81e-3 * 46.0)); }

/// The time at which the angle is zero, through six nodes around it: Neville's scheme for t(angle).
double time_of_zero(std::array<double, 6> t, const std::array<double, 6>& angle) {
  for (std::size_t level = 1; level < 6; ++level) {
    for (std::size_t i = 0; i + level < 6; ++i) {
      t[i] = (angle[i + level] * t[i] - angle[i] * t[i + 1]) / (angle[i + level] - angle[i]);
    }
  }
  return t[0];
}

struct Swing {
  double period = 0.0;
  double energy_error = 0.0;
};

/// Releases the pendulum at rest and measures from the first to the third passage through the bottom.
Swing swing(double release, double dt) {
  const auto model = test::make_model(test::pendulum());
  const State start =
      test::state_at(*model, Eigen::VectorXd::Constant(1, release - 0.5 * pi), Eigen::VectorXd::Zero(1));
  Swing result;
  std::vector<double> angles;
  const auto steps = static_cast<long>(1.4 * small_period() * period_ratio(release) / dt);
  const test::Run done = test::run(*model, start, {.dt = dt, .steps = steps}, [&](const NodeRecord& node) {
    angles.push_back(node.state.x[0] + 0.5 * pi);
    const double total = node.values.total.kinetic + node.values.total.potential();
    result.energy_error = std::max(result.energy_error, std::abs(total - node.ledger.initial_total));
  });
  EXPECT_EQ(done.result.status, Status::completed);
  std::vector<double> passages;
  for (std::size_t n = 2; n + 3 < angles.size(); ++n) {
    if ((angles[n] > 0.0) == (angles[n + 1] > 0.0)) continue;
    std::array<double, 6> t{};
    std::array<double, 6> angle{};
    for (std::size_t k = 0; k < 6; ++k) {
      t[k] = static_cast<double>(n - 2 + k) * dt;
      angle[k] = angles[n - 2 + k];
    }
    passages.push_back(time_of_zero(t, angle));
  }
  EXPECT_GE(passages.size(), 3u);
  result.period = passages.at(2) - passages.at(0);
  return result;
}

TEST(Pendulum, PeriodRatiosAreThoseOfTheTable) {
  const std::vector<std::pair<double, double>> table{{10.0, 1.00190718814},
                                                     {45.0, 1.0399733432},
                                                     {90.0, 1.18034059902},
                                                     {120.0, 1.37288050062},
                                                     {170.0, 2.43936271967}};
  for (const auto& [degrees, ratio] : table) EXPECT_NEAR(period_ratio(degrees * test::degree), ratio, 1e-11 * ratio);
  EXPECT_NEAR(small_period(), 937.248884852, 1e-9 * 937.0);
}

TEST(Pendulum, PeriodsConvergeToTheClosedForm) {
  for (const double degrees : {10.0, 45.0, 90.0, 120.0, 170.0}) {
    const double release = degrees * test::degree;
    const double exact = small_period() * period_ratio(release);
    const double coarse = swing(release, 2.5).period;
    const double fine = swing(release, 1.25).period;
    const double limit = test::extrapolated(coarse, fine);
    std::cout << degrees << " deg: " << limit / exact - 1.0 << " of the period, ratio "
              << (coarse - exact) / (fine - exact) << '\n';
    EXPECT_NEAR(limit, exact, 1e-6 * exact) << degrees;
    EXPECT_NEAR((coarse - exact) / (fine - exact), 4.0, 0.05) << degrees;
  }
}

TEST(Pendulum, ReleasedAtNinetyDegreesHasThePeriodsAndEnergyErrorsOfTheTable) {
  struct Row {
    double dt;
    double period;
    double energy_error;
  };
  // Energies: half a unit of the last printed digit. Periods: the table's passages agree with ours to 2e-7.
  for (const Row& row : {Row{10.0, 1105.5617, 0.0304}, Row{5.0, 1106.0953, 0.00761}, Row{2.5, 1106.2285, 0.00190}}) {
    const Swing found = swing(90.0 * test::degree, row.dt);
    std::cout << "dt " << row.dt << ": " << std::to_string(found.period) << ' ' << found.energy_error << '\n';
    EXPECT_NEAR(found.period, row.period, 2e-7 * row.period) << row.dt;
    EXPECT_NEAR(found.energy_error, row.energy_error, row.dt == 10.0 ? 6e-5 : 6e-6) << row.dt;
  }
}

}  // namespace
}  // namespace muldi::variational
