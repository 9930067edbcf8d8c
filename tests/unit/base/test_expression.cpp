#include "base/expression.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace muldi::base {
namespace {

std::string error_of(std::string_view text) {
  std::string error;
  EXPECT_EQ(Expression::make(text, error).at(1.0), text == "1" ? 1.0 : 0.0);
  return error;
}

TEST(Expression, EvaluatesAFormulaOfTime) {
  std::string error;
  const Expression expression = Expression::make("30*(1-exp(-t/20)) + sin(pi/2)", error);
  EXPECT_EQ(error, "");
  EXPECT_DOUBLE_EQ(expression.at(0.0), 1.0);
  EXPECT_DOUBLE_EQ(expression.at(20.0), 30.0 * (1.0 - std::exp(-1.0)) + 1.0);
}

TEST(Expression, CopiesAreIndependent) {
  std::string error;
  const Expression first = Expression::make("2*t", error);
  Expression second = first;
  EXPECT_EQ(second.at(3.0), 6.0);
  EXPECT_EQ(first.at(1.0), 2.0);
  second = Expression::make("t", error);
  EXPECT_EQ(second.at(3.0), 3.0);
  EXPECT_EQ(first.at(3.0), 6.0);
}

TEST(Expression, EqualWhereTheTextsAre) {
  std::string error;
  EXPECT_EQ(Expression::make("t", error), Expression::make("t", error));
  EXPECT_NE(Expression::make("t", error), Expression::make("2*t", error));
}

TEST(Expression, DefaultIsZero) { EXPECT_EQ(Expression().at(5.0), 0.0); }

TEST(Expression, SaysWhereItIsWrong) {
  EXPECT_EQ(error_of("2*x"), "cannot read the expression '2*x': Unexpected token \"x\" found at position 2");
  EXPECT_EQ(error_of("(t"), "cannot read the expression '(t': Missing parenthesis");
  EXPECT_EQ(error_of(""), "cannot read the expression '': Expression is empty");
  EXPECT_EQ(error_of("t, 2"), "the expression 't, 2' has more than one value");
}

TEST(Expression, IsNotFiniteWhereTheFormulaIsNot) {
  std::string error;
  EXPECT_FALSE(std::isfinite(Expression::make("1/t", error).at(0.0)));
  EXPECT_TRUE(std::isnan(Expression::make("sqrt(t)", error).at(-1.0)));
}

}  // namespace
}  // namespace muldi::base
