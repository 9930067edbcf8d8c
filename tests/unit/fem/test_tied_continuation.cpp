/// Continuation with solids tied to bodies: limit points of a joint between two muscles, both branches, and what load
/// stepping says of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "statics/sweep.hpp"
#include "support/tied_system.hpp"

namespace muldi::fem {
namespace {

using Eigen::VectorXd;
using statics::Continuation;
using statics::CriticalPoint;
using statics::Stability;
using statics::SweepOptions;
using statics::SweepResult;

struct Curve {
  SweepResult result;
  std::vector<double> loads;
  std::vector<double> angles;
  std::vector<bool> stable;
  std::vector<double> residuals;
};

/// One joint between two muscles of eight cells; kV/mm, the field of the right muscle swept, or of both.
class TiedContinuation : public ::testing::Test {
 protected:
  static Curve sweep(const SweepOptions& options, bool both) {
    test::TiedSystem system = test::chain_with_muscles(1, {.cells = {1, 1, 8}, .permittivity = 3.7 * 8.8542});
    system.rigid.controls.assign(2, {.name = "field", .unit = {}, .function = 0.0});
    const auto model = test::make_model(system);
    statics::StaticState state = test::static_start(*model);
    statics::Sweep sweep(*model, {0.0, 0.0}, {1.0, both ? 1.0 : 0.0}, options);
    Curve curve;
    curve.result = sweep.run(state, {.record = [&](const statics::SweepPoint& at) {
                               curve.loads.push_back(at.load);
                               curve.angles.push_back(at.state.x[0]);
                               curve.stable.push_back(at.report.stability == Stability::stable);
                               curve.residuals.push_back(at.report.residual);
                             }});
    return curve;
  }
};

TEST_F(TiedContinuation, ArcLengthFindsTheLimitThatLoadStepsBracket) {
  const Curve natural = sweep({.from = 0.0, .to = 80.0, .steps = 8}, false);
  ASSERT_EQ(natural.result.end, SweepResult::End::loss_of_equilibrium);
  const Curve arc = sweep({.from = 0.0, .to = 80.0, .steps = 8, .continuation = Continuation::arc_length}, false);
  ASSERT_FALSE(arc.result.critical.empty());
  EXPECT_EQ(arc.result.critical[0].kind, CriticalPoint::Kind::limit);
  EXPECT_GT(arc.result.critical[0].load, natural.result.last_good);
  EXPECT_LT(arc.result.critical[0].load, natural.result.first_bad);
  // Behind it one cell pulls in alone, which no mesh resolves: there the curve ends.
  EXPECT_EQ(arc.result.end, SweepResult::End::completed);
  EXPECT_EQ(arc.result.sentence.find("the curve ends at the load "), 0U) << arc.result.sentence;
  EXPECT_NE(
      arc.result.sentence.find(
          ": cell 6 at [12, 0, 29.25] of solid 'right0' gives way alone: it keeps its volume as a whole, but of the "
          "part at one of its Gauss points "),
      std::string::npos)
      << arc.result.sentence;
  EXPECT_LT(arc.loads.back(), arc.result.critical[0].load);
}

}  // namespace
}  // namespace muldi::fem
