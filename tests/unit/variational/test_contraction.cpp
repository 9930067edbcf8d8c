/// When Newton's iteration with kept factors ends, and when it asks for a new factor.
#include "variational/contraction.hpp"

#include <gtest/gtest.h>

#include "variational/factor_use.hpp"

namespace muldi::variational {
namespace {

constexpr double tolerance = 1e-10;

/// Increments of positions and stage unknowns, and the larger of the two as that of all.
Increment of(double length, double stage) {
  return {.size = length > stage ? length : stage, .length = length, .stage = stage};
}

Contraction after(std::initializer_list<Increment> increments) {
  Contraction contraction;
  for (const Increment& increment : increments) contraction.take(increment, false, 1e-6);
  return contraction;
}

TEST(Contraction, IsNotSmallBeforeTheFirstIncrement) { EXPECT_FALSE(Contraction().is_small(tolerance)); }

TEST(Contraction, TakesPositionsByTheirIncrementAlone) {
  EXPECT_TRUE(after({of(1e-10, 0.0)}).is_small(tolerance));
  EXPECT_FALSE(after({of(1e-6, 0.0), of(1.01e-10, 0.0)}).is_small(tolerance));
}

// Increments a, a r, a r^2 ... : behind a r the rest of the series is a r r/(1 - r).
TEST(Contraction, TakesStageUnknownsByTheRestOfTheirGeometricSeries) {
  const double r = 0.01;
  const double just = tolerance * (1.0 - r) / r;  // the last increment whose rest is the tolerance
  EXPECT_TRUE(after({of(1e-8, just / r), of(1e-11, 0.999 * just)}).is_small(tolerance));
  EXPECT_FALSE(after({of(1e-8, 1.01 * just / r), of(1e-11, 1.01 * just)}).is_small(tolerance));
}

TEST(Contraction, BelievesNoSeriesOfOneIncrementNorASlowOne) {
  EXPECT_FALSE(after({of(1e-11, 1.01e-10)}).is_small(tolerance));
  EXPECT_TRUE(after({of(1e-11, 1e-10)}).is_small(tolerance));
  EXPECT_FALSE(after({of(1e-11, 1.5e-10), of(1e-11, 1.01e-10)}).is_small(tolerance));
}

TEST(Contraction, IsSlowOnlyWithAFactorThatHasServedAnIncrement) {
  Contraction contraction;
  contraction.take(of(1e-4, 0.0), false, 1e-6);
  EXPECT_FALSE(contraction.is_slow(tolerance));
  contraction.take(of(5e-5, 0.0), false, 1e-6);
  EXPECT_TRUE(contraction.is_slow(tolerance));
  contraction.take(of(5e-5, 0.0), true, 1e-6);
  EXPECT_FALSE(contraction.is_slow(tolerance));
  contraction.take(of(3e-5, 0.0), false, 1e-6);
  EXPECT_TRUE(contraction.is_slow(tolerance));
  EXPECT_TRUE(contraction.judges_new_factor());
}

TEST(Contraction, StagnatesInRoundOffOnly) {
  Contraction contraction;
  for (const double size : {1e-4, 1e-6, 1e-8, 0.9e-8}) contraction.take(of(size, 0.0), false, 1e-11);
  EXPECT_FALSE(contraction.stagnates());
  contraction.take(of(0.8e-8, 0.0), false, 9e-13);
  EXPECT_TRUE(contraction.stagnates());
}

TEST(FactorUse, RenewsWhereAStepCostsMoreThanTheMeanOfAllWithTheFactor) {
  // With the cost 6 of a factor and 3, 3, 3, 4, 5 iterations the means are 9, 6, 5, 4.75, 4.8: best after four steps.
  FactorUse use;
  use.book(3, true);
  for (const int iterations : {3, 3, 4}) {
    use.book(iterations, false);
    EXPECT_FALSE(use.renews);
  }
  use.book(5, false);
  EXPECT_TRUE(use.renews);
}

TEST(FactorUse, NeverRenewsAFactorThatDoesNotAge) {
  FactorUse use;
  use.book(4, true);
  for (int step = 0; step < 1000; ++step) use.book(4, false);
  EXPECT_FALSE(use.renews);
}

TEST(FactorUse, CountsFromTheStepWithTheNewFactor) {
  FactorUse use;
  use.book(3, true);
  for (int step = 0; step < 20; ++step) use.book(3, false);
  use.book(9, false);
  EXPECT_TRUE(use.renews);
  use.book(4, true);
  EXPECT_EQ(use.steps, 1);
  EXPECT_EQ(use.iterations, 4);
  EXPECT_FALSE(use.renews);
}

}  // namespace
}  // namespace muldi::variational
