#include "base/log.hpp"

#include <gtest/gtest.h>

#include <string>

namespace muldi::base {
namespace {

/// What all levels print at a verbosity.
std::string printed(Verbosity at) {
  const Verbosity before = verbosity();
  set_verbosity(at);
  testing::internal::CaptureStderr();
  log_error("e {}");
  log_warning("w");
  log_info("i");
  log_verbose("v");
  log_debug("d");
  log_plain("f:1:2: error: p");
  set_verbosity(before);
  return testing::internal::GetCapturedStderr();
}

TEST(Log, QuietKeepsWarningsAndErrors) {
  EXPECT_EQ(printed(Verbosity::quiet), "error: e {}\nwarning: w\nf:1:2: error: p\n");
}

TEST(Log, NormalAddsWhatHappens) {
  EXPECT_EQ(printed(Verbosity::normal), "error: e {}\nwarning: w\ni\nf:1:2: error: p\n");
}

TEST(Log, VerboseAndDebugAddDetails) {
  EXPECT_EQ(printed(Verbosity::verbose), "error: e {}\nwarning: w\ni\nv\nf:1:2: error: p\n");
  EXPECT_EQ(printed(Verbosity::debug), "error: e {}\nwarning: w\ni\nv\nd\nf:1:2: error: p\n");
}

TEST(Log, NothingGoesToStdout) {
  testing::internal::CaptureStdout();
  printed(Verbosity::debug);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace muldi::base
