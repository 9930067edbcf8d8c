/// A parallelogram can turn into an antiparallelogram where its bars are in line; that never happens unsaid
/// (numerics 1.9, 5 no. 20).
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "support/linkages.hpp"
#include "support/trajectory.hpp"

namespace muldi {
namespace {

using variational::Status;

struct Passage {
  Status status = Status::running;
  bool warned = false;
  bool passed_unsaid = false;  ///< in line before a word
  bool jumped_unsaid = false;  ///< off the parallel branch before a word
  double crank = 0.0;
};

Passage turn(double dt, long steps) {
  // Crank and rocker 30, coupler and ground 100.
  const auto model = test::make_model(
      test::four_bar({.ground = 100.0, .crank = 30.0, .coupler = 100.0, .rocker = 30.0, .crank_angle = 1.0}, 0.0));
  variational::State state =
      test::state_at(*model, model->manifold->reference(), test::admissible_rates(*model, 0, 0.01));
  variational::TimeLoop loop(*model, {.dt = dt, .steps = steps});
  variational::Ledger ledger;
  variational::StepReport last;
  Passage result;
  double closed_to = 0.0;
  // The coupler, body 1, stays parallel to ground on the branch of the start.
  const double along = state.q[12 + 3];
  const auto look = [&](const variational::NodeRecord& node) {
    closed_to = std::max(closed_to, model->manifold->violation(node.state.q));
    // A node is shown after the step that follows it: a warning may be one step early here, never late.
    const double angle = 1.0 + node.state.x[0];
    if (!result.warned && angle > std::numbers::pi) result.passed_unsaid = true;
    if (!result.warned && std::abs(node.state.q[12 + 3] - along) > 1e-3) result.jumped_unsaid = true;
  };
  const variational::LoopResult done =
      loop.run(state, ledger, last, {.record = look, .warn = [&](const variational::StepReport& report, double) {
                                       if (report.loop_regularity < 1e-2) result.warned = true;
                                     }});
  result.status = done.status;
  result.crank = 1.0 + state.x[0];
  EXPECT_LT(closed_to, 1e-10) << dt;
  return result;
}

TEST(ChangePoint, OfAParallelogramIsNeverPassedUnsaid) {
  for (const double dt : {0.1, 0.37, 1.0, 2.3, 5.0, 11.0, 20.0}) {
    const Passage passage = turn(dt, static_cast<long>(700.0 / dt));
    std::cout << "dt " << dt << ": " << name_of(passage.status) << (passage.warned ? ", warned" : "") << ", crank at "
              << passage.crank << " rad\n";
    EXPECT_TRUE(passage.warned || passage.status == Status::rank_change) << dt;
    EXPECT_FALSE(passage.passed_unsaid) << dt;
    EXPECT_FALSE(passage.jumped_unsaid) << dt;
  }
}

TEST(ChangePoint, FarFromOneNothingIsSaid) {
  // A crank-rocker of other lengths turns through without a change point.
  const auto model = test::make_model(test::four_bar({}, 0.0));
  variational::State state =
      test::state_at(*model, model->manifold->reference(), test::admissible_rates(*model, 0, 0.01));
  variational::TimeLoop loop(*model, {.dt = 2.0, .steps = 2000});
  variational::Ledger ledger;
  variational::StepReport last;
  int warnings = 0;
  const variational::LoopResult done =
      loop.run(state, ledger, last, {.record = {}, .warn = [&](const auto&, double) { ++warnings; }});
  EXPECT_EQ(done.status, Status::completed) << done.sentence;
  EXPECT_EQ(warnings, 0);
  EXPECT_GT(std::abs(state.x[0]), 2.0 * std::numbers::pi) << "more than a turn";
}

}  // namespace
}  // namespace muldi
