#pragma once
/// Formulas of one variable `t` as text; the only file pair that includes muParser.
#include <memory>
#include <string>
#include <string_view>

namespace muldi::base {

/// A compiled formula, e.g. `30*(1-exp(-t/20))`. A value type; equal when the texts are. One object must not be
/// evaluated by two threads at once.
class Expression {
 public:
  /// Compiles `text`; on failure `error` gets a sentence and the expression is 0.
  static Expression make(std::string_view text, std::string& error);

  Expression();
  Expression(const Expression& other);
  Expression(Expression&& other) noexcept;
  Expression& operator=(const Expression& other);
  Expression& operator=(Expression&& other) noexcept;
  ~Expression();

  /// The value at `t`; not finite where the formula is not.
  double at(double t) const;
  const std::string& text() const { return text_; }

  friend bool operator==(const Expression& a, const Expression& b) { return a.text_ == b.text_; }

 private:
  struct Program;

  std::string text_ = "0";
  std::unique_ptr<Program> program_;
};

}  // namespace muldi::base
