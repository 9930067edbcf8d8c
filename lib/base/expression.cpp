#include "base/expression.hpp"

#include <muParser.h>

#include <limits>
#include <utility>

#include "base/text.hpp"

namespace muldi::base {

struct Expression::Program {
  double t = 0.0;
  mu::Parser parser;

  explicit Program(const std::string& text) {
    parser.DefineConst("pi", 3.14159265358979323846);
    parser.DefineVar("t", &t);
    parser.SetExpr(text);
    parser.Eval();  // compiles it, so that later evaluations do not allocate
  }
};

Expression::Expression() = default;
Expression::~Expression() = default;
Expression::Expression(Expression&& other) noexcept = default;
Expression& Expression::operator=(Expression&& other) noexcept = default;

Expression::Expression(const Expression& other)
    : text_(other.text_), program_(other.program_ ? std::make_unique<Program>(other.text_) : nullptr) {}

Expression& Expression::operator=(const Expression& other) {
  Expression copy(other);
  std::swap(*this, copy);
  return *this;
}

Expression Expression::make(std::string_view text, std::string& error) {
  Expression expression;
  try {
    expression.text_ = std::string(text);
    expression.program_ = std::make_unique<Program>(expression.text_);
    int n_results = 0;
    expression.program_->parser.Eval(n_results);
    if (n_results == 1) return expression;
    error = "the expression " + in_quotes(text) + " has more than one value";
  } catch (const mu::Parser::exception_type& failure) {
    const std::string_view why = failure.GetMsg();
    error = "cannot read the expression " + in_quotes(text) + ": " +
            std::string(why.substr(0, why.find_last_not_of('.') + 1));
  }
  return {};
}

double Expression::at(double t) const {
  if (!program_) return 0.0;
  program_->t = t;
  try {
    return program_->parser.Eval();
  } catch (const mu::Parser::exception_type&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace muldi::base
