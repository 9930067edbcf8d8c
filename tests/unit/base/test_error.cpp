#include "base/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace muldi::base {
namespace {

TEST(InputError, CarriesAllDiagnosticsAndPrintsThem) {
  const std::vector<Diagnostic> both{{.path = "a", .message = "first"}, {.path = "b", .message = "second"}};
  const InputError error(both);
  EXPECT_EQ(error.diagnostics(), both);
  EXPECT_STREQ(error.what(), "error: a: first\nerror: b: second");
}

TEST(InputError, TakesABareMessage) {
  const InputError error("no such file");
  ASSERT_EQ(error.diagnostics().size(), 1u);
  EXPECT_STREQ(error.what(), "error: no such file");
}

TEST(Expect, ThrowsWithConditionAndReason) {
  const auto broken = [] { MULDI_EXPECT(1 + 1 == 3, "sums are right"); };
  try {
    broken();
    FAIL() << "nothing was thrown";
  } catch (const ContractError& error) {
    EXPECT_THAT(error.what(), testing::MatchesRegex(".*test_error.cpp:[0-9]+: sums are right .expected 1 \\+ 1 == 3."));
  }
}

TEST(Expect, PassesWhatHolds) { EXPECT_NO_THROW(MULDI_EXPECT(1 + 1 == 2, "sums are right")); }

}  // namespace
}  // namespace muldi::base
