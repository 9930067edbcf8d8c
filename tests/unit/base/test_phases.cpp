#include "base/phases.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace muldi::base {
namespace {

TEST(Phases, AddUpByNameInTheOrderOfTheirFirstEntry) {
  Phases phases;
  phases.add("read", 0.5);
  phases.add("step", 1.0);
  phases.add("read", 0.25);
  ASSERT_EQ(phases.all().size(), 2u);
  EXPECT_EQ(phases.all()[0].name, "read");
  EXPECT_EQ(phases.all()[0].count, 2);
  EXPECT_EQ(phases.seconds("read"), 0.75);
  EXPECT_EQ(phases.seconds("step"), 1.0);
  EXPECT_EQ(phases.seconds("write"), 0.0);
}

TEST(Phases, ScopeMeasuresItsLife) {
  Phases phases;
  {
    const Phases::Scope outer(phases, "outer");
    const Phases::Scope inner(phases, "inner");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_GE(phases.seconds("inner"), 0.005);
  EXPECT_GE(phases.seconds("outer"), phases.seconds("inner"));
  EXPECT_LT(phases.seconds("outer"), 5.0);  // a loaded machine, not a stuck clock
}

}  // namespace
}  // namespace muldi::base
