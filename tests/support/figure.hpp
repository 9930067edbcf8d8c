#pragma once
/// Figures of the stress suite: numbers that a test demands a bound of and that the page of tools/stress shows.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace muldi::test {

/// Appends a figure as one line of JSON to the file that the environment variable MULDI_FIGURES names, if it is set.
///
/// `entry`: number in numerics 5, a key of tests/stress/register.yaml; `what`: the figure in words, without quotes;
/// `demand`: e.g. "<= 1e-10".
inline void write_figure(const std::string& entry, const std::string& what, double value, const std::string& demand) {
  const char* path = std::getenv("MULDI_FIGURES");
  if (path == nullptr) return;
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  std::ostringstream line;
  line.precision(17);
  line << R"({"entry": ")" << entry << R"(", "what": ")" << what << R"(", "value": ")" << value << R"(", "demand": ")"
       << demand << R"(", "test": ")" << test->test_suite_name() << '.' << test->name() << "\"}\n";
  // One write of a short line: tests run side by side.
  std::ofstream(path, std::ios::app) << line.str() << std::flush;
}

/// A number as short as it can be said.
inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// Demands value <= bound (NaN fails) and records both.
inline void record_figure(const std::string& entry, const std::string& what, double value, double bound) {
  EXPECT_LE(value, bound) << "entry " << entry << ": " << what;
  write_figure(entry, what, value, "<= " + short_number(bound));
}

/// Demands value >= bound (NaN fails) and records both.
inline void record_at_least(const std::string& entry, const std::string& what, double value, double bound) {
  EXPECT_GE(value, bound) << "entry " << entry << ": " << what;
  write_figure(entry, what, value, ">= " + short_number(bound));
}

/// Demands |value - expected| <= tolerance (NaN fails) and records all three.
inline void record_near(const std::string& entry, const std::string& what, double value, double expected,
                        double tolerance) {
  EXPECT_NEAR(value, expected, tolerance) << "entry " << entry << ": " << what;
  write_figure(entry, what, value, short_number(expected) + " +- " + short_number(tolerance));
}

}  // namespace muldi::test
