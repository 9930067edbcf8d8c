/// A closed loop over a million steps (numerics 5 no. 20): any two of the five rows of Bennett's linkage lose rank
/// somewhere in a turn, the linkage itself never does.
#include <gtest/gtest.h>

#include <iostream>
#include <limits>
#include <numbers>

#include "stress/energy_history.hpp"
#include "support/figure.hpp"
#include "support/linkages.hpp"

namespace muldi {
namespace {

TEST(MillionSteps, OfABennettLinkageNeverLoseRank) {
  const long steps = 1'000'000;
  const auto model = test::make_model(test::bennett(1.0));
  const variational::State start =
      test::state_at(*model, model->manifold->reference(), test::admissible_rates(*model, 0, 0.01));
  double regularity = 1.0;
  test::EnergyHistory history(*model, steps);
  const test::Run done = test::run(*model, start, {.dt = 2.0, .steps = steps}, [&](const auto& node) {
    history.add(node);
    regularity = std::min(regularity, node.report.loop_regularity);
  });
  ASSERT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
  const double energy = done.ledger.initial_total;
  std::cout << "turns " << std::abs(done.state.x[0]) / (2.0 * std::numbers::pi) << ", regularity " << regularity
            << ", violation " << history.violation() << ", band " << history.band().all / energy
            << " of the energy, drift " << history.drift() / energy << '\n';
  EXPECT_GT(std::abs(done.state.x[0]), 1000.0 * 2.0 * std::numbers::pi) << "a thousand turns";
  EXPECT_GT(regularity, 0.4);
  // Angles of thousands of turns are rounded to 1e-12: what is left of the rows grows with the angle, not with the
  // steps.
  test::record_figure("20", "Bennett linkage, 1e6 steps, violation of all rows", history.violation(), 1e-10);
  const double spacing = std::numeric_limits<double>::epsilon() * std::abs(done.state.x[0]);
  test::record_figure("20", "Bennett linkage, 1e6 steps, violation over the spacing of numbers at the angle turned",
                      history.violation() / spacing, 10.0);
  test::record_figure("20", "Bennett linkage, 1e6 steps, energy band of the last tenth over that of the first",
                      history.band().last_tenth / history.band().first_tenth, 1.1);
  test::record_figure("20", "Bennett linkage, 1e6 steps, drift of the mean energy", std::abs(history.drift()) / energy,
                      1e-9);
}

}  // namespace
}  // namespace muldi
