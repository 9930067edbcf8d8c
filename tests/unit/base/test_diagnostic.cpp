#include "base/diagnostic.hpp"

#include <gtest/gtest.h>

namespace muldi::base {
namespace {

TEST(Diagnostic, PrintsPlaceSeverityPathAndMessage) {
  const Diagnostic diagnostic{.place = {.file = "scenes/joint.yaml", .line = 14, .column = 11},
                              .severity = Severity::error,
                              .path = "muscles.upper.to.body",
                              .message = "no body 'pendullum' (did you mean 'pendulum'?)"};
  EXPECT_EQ(to_string(diagnostic),
            "scenes/joint.yaml:14:11: error: muscles.upper.to.body: no body 'pendullum' (did you mean 'pendulum'?)");
}

TEST(Diagnostic, LeavesOutPartsWithoutContent) {
  EXPECT_EQ(to_string(Diagnostic{.message = "m"}), "error: m");
  EXPECT_EQ(to_string(Diagnostic{.place = {.file = "f"}, .severity = Severity::warning, .message = "m"}),
            "f: warning: m");
  EXPECT_EQ(to_string(Diagnostic{.place = {.file = "f", .line = 3}, .severity = Severity::note, .message = "m"}),
            "f:3: note: m");
}

TEST(Diagnostic, ListHasOneLineEach) {
  EXPECT_EQ(to_string(std::vector<Diagnostic>{{.message = "a"}, {.message = "b"}}), "error: a\nerror: b");
  EXPECT_EQ(to_string(std::vector<Diagnostic>{}), "");
}

TEST(Nearest, FindsTypingErrors) {
  const std::vector<std::string> names{"pendulum", "base", "arm"};
  EXPECT_EQ(nearest("pendullum", names), "pendulum");  // one letter too many
  EXPECT_EQ(nearest("pednulum", names), "pendulum");   // neighbours swapped
  EXPECT_EQ(nearest("bse", names), "base");            // one letter missing
  EXPECT_EQ(nearest("amr", names), "arm");
}

TEST(Nearest, FindsNothingFarAway) {
  const std::vector<std::string> names{"pendulum", "base", "arm"};
  EXPECT_EQ(nearest("spring", names), "");
  EXPECT_EQ(nearest("", names), "");
  EXPECT_EQ(nearest(std::string(1000, 'a'), names), "");
  EXPECT_EQ(nearest("x", {"y"}), "");  // nothing in common
  EXPECT_EQ(nearest("x", {}), "");
}

TEST(Nearest, PrefersTheSmallestDistanceThenTheFirst) {
  EXPECT_EQ(nearest("joint", {"joints", "joint_a"}), "joints");
  EXPECT_EQ(nearest("arm", {"arm1", "arm2"}), "arm1");
}

TEST(DidYouMean, SuggestsOrListsOrSaysNothing) {
  EXPECT_EQ(did_you_mean("bse", {"base", "arm"}), " (did you mean 'base'?)");
  EXPECT_EQ(did_you_mean("spring", {"base", "arm"}), " (known: base, arm)");
  EXPECT_EQ(did_you_mean("spring", {}), "");
  EXPECT_EQ(did_you_mean("spring", std::vector<std::string>(13, "arm")), "");
}

}  // namespace
}  // namespace muldi::base
