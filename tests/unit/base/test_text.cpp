#include "base/text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace muldi::base {
namespace {

TEST(NumberText, ReadsBackTheSame) {
  for (const double value : {0.1, 1.0 / 3.0, 8.8542e-12, -7.7284947404, 1e300, 5e-324, 0.0}) {
    EXPECT_EQ(parse_number(number_text(value)), value);
  }
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(2.0 / 3.0, 3), "0.667");
}

TEST(ParseNumber, TakesDecimalForms) {
  EXPECT_EQ(parse_number("1.0e+5"), 1e5);
  EXPECT_EQ(parse_number(" +3 "), 3.0);
  EXPECT_EQ(parse_number("-.5"), -0.5);
  EXPECT_EQ(parse_number("5."), 5.0);
  EXPECT_EQ(parse_number("1E-3"), 1e-3);
}

TEST(ParseNumber, RefusesEverythingElse) {
  for (const char* text : {"", "x", "1x", "1 2", "0x10", "--1", "+-1", "1e", "1,5", "1_000"}) {
    EXPECT_EQ(parse_number(text), std::nullopt) << text;
  }
}

TEST(ParseNumber, TellsWhatIsNotFinite) {
  EXPECT_EQ(parse_number("1e400"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(parse_number("-1e400"), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(parse_number("1e-400"), 0.0);
  EXPECT_EQ(parse_number("-.inf"), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(parse_number(".nan").value()));
  EXPECT_TRUE(std::isnan(parse_number("nan").value()));
}

TEST(TakeNumber, StopsAtTheUnit) {
  std::string_view text = "30 kV/mm";
  EXPECT_EQ(take_number(text), 30.0);
  EXPECT_EQ(text, " kV/mm");
  text = "kV";
  EXPECT_EQ(take_number(text), std::nullopt);
  EXPECT_EQ(text, "kV");
}

TEST(InQuotes, ShortensAndCleans) {
  EXPECT_EQ(in_quotes("arm"), "'arm'");
  EXPECT_EQ(in_quotes("a\nb"), "'a?b'");
  const std::string text = in_quotes(std::string(100, 'a') + std::string(100, 'b'));
  EXPECT_EQ(text, "'" + std::string(30, 'a') + "..." + std::string(20, 'b') + "'");
}

TEST(Text, FormatsJoinsAndTrims) {
  EXPECT_EQ(format("{} of {:.1f}", 3, 2.25), "3 of 2.2");
  EXPECT_EQ(joined(std::vector<std::string>{"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(joined(std::vector<std::string>{}), "");
  EXPECT_EQ(trimmed(" \t a b\r\n"), "a b");
}

}  // namespace
}  // namespace muldi::base
