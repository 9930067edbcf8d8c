/// Closed loops over long runs (numerics 5 no. 20).
#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "stress/energy_history.hpp"
#include "support/figure.hpp"
#include "support/linkages.hpp"

namespace muldi {
namespace {

constexpr double gravity = 9.81e-3;

TEST(LongLoops, FourBarStaysClosedAndKeepsItsEnergyBand) {
  const auto model = test::make_model(test::four_bar({}, gravity));
  const variational::State start = test::state_at_rest(*model);
  const test::EnergyHistory coarse = test::energy_history(*model, start, 2.0, 100'000);
  const test::EnergyHistory fine = test::energy_history(*model, start, 1.0, 100'000);
  std::cout << "band " << coarse.band().all / coarse.swing() << " of " << coarse.swing() << " mJ, last/first tenth "
            << coarse.band().last_tenth / coarse.band().first_tenth << ", ratio " << coarse.band().all / fine.band().all
            << ", violation " << coarse.violation() << '\n';
  test::record_figure("20", "four-bar, 1e5 steps, energy band of the last tenth over that of the first",
                      coarse.band().last_tenth / coarse.band().first_tenth, 1.1);
  test::record_near("20", "four-bar, energy band over that of half the step", coarse.band().all / fine.band().all, 4.0,
                    0.2);
  test::record_figure("20", "four-bar, 1e5 steps, violation of constraints", coarse.violation(), 1e-11);
}

TEST(LongLoops, AQuickReturnWhoseRowsTurnKeepsItsEnergyBand) {
  const auto model = test::make_model(test::quick_return(gravity));
  ASSERT_EQ(test::manifold_of(*model).tree().cut_joints, std::vector<int>{4}) << "the sliding joint closes the loop";
  ASSERT_EQ(model->manifold->n_v() - model->manifold->n_c(), 1);
  const variational::State start = test::state_at_rest(*model);
  const test::EnergyHistory coarse = test::energy_history(*model, start, 2.0, 20'000);
  const test::EnergyHistory fine = test::energy_history(*model, start, 1.0, 40'000);
  test::record_figure("20", "quick-return, 2e4 steps, energy band of the last tenth over that of the first",
                      coarse.band().last_tenth / coarse.band().first_tenth, 1.1);
  test::record_near("20", "quick-return, energy band over that of half the step", coarse.band().all / fine.band().all,
                    4.0, 0.2);
  test::record_figure("20", "quick-return, 4e4 steps, violation of constraints", fine.violation(), 1e-11);
}

TEST(LongLoops, BennettLinkageTurnsThroughWithItsOneFreedom) {
  const auto model = test::make_model(test::bennett(1.0));
  ASSERT_EQ(model->manifold->n_v() - model->manifold->n_c(), 1);
  const variational::State start =
      test::state_at(*model, model->manifold->reference(), test::admissible_rates(*model, 0, 0.01));
  double turned = 0.0;
  double regularity = 1.0;
  test::EnergyHistory history(*model, 20'000);
  const test::Run done = test::run(*model, start, {.dt = 0.5, .steps = 20'000}, [&](const auto& node) {
    history.add(node);
    turned = std::max(turned, std::abs(node.state.x[0]));
    regularity = std::min(regularity, node.report.loop_regularity);
  });
  ASSERT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
  std::cout << "turns " << turned / (2.0 * std::numbers::pi) << ", violation " << history.violation() << ", band "
            << history.band().all / done.ledger.initial_total << " of the energy, regularity " << regularity << '\n';
  EXPECT_GT(turned, 10.0 * 2.0 * std::numbers::pi) << "ten turns";
  EXPECT_GT(regularity, 0.4) << "any two of the five rows lose rank twice a turn, the linkage never does";
  test::record_figure("20", "Bennett linkage, 2e4 steps, violation of all rows", history.violation(), 1e-10);
  EXPECT_LE(history.band().last_tenth, 1.1 * history.band().first_tenth);
}

}  // namespace
}  // namespace muldi
