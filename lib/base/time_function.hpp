#pragma once
/// Functions of time as scenes give them, in the scene's units. Over a step the integrator takes the value at
/// t_n + dt/2: for held functions the held value, for smooth ones second order.
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/expression.hpp"

namespace muldi::base {

/// Values at increasing times.
struct Samples {
  enum class Between { held, linear };

  Between between = Between::held;
  std::vector<double> times = {};
  std::vector<double> values = {};

  /// The value at `t`: that of the last time not after t (held) or on the straight line between neighbours (linear);
  /// before the first and after the last time their values.
  double at(double t) const;
  friend bool operator==(const Samples&, const Samples&) = default;
};

/// From `from` to `to` on a straight line over [start, start + over].
struct Ramp {
  double from = 0.0;
  double to = 0.0;
  double start = 0.0;
  double over = 0.0;

  double at(double t) const;
  friend bool operator==(const Ramp&, const Ramp&) = default;
};

/// offset + amplitude sin(2 pi frequency t + phase).
struct Sine {
  double amplitude = 0.0;
  double frequency = 0.0;  ///< revolutions a unit of time
  double phase = 0.0;      ///< rad
  double offset = 0.0;

  double at(double t) const;
  friend bool operator==(const Sine&, const Sine&) = default;
};

/// A function of time; a constant unless said. A value type.
class TimeFunction {
 public:
  using Kind = std::variant<double, Samples, Ramp, Sine, Expression>;

  TimeFunction() = default;
  TimeFunction(double constant) : kind_(constant) {}  // NOLINT(google-explicit-constructor): a number is a function
  explicit TimeFunction(Kind kind) : kind_(std::move(kind)) {}

  /// The value at time t; NaN where a formula has none.
  double at(double t) const;
  bool is_constant() const { return std::holds_alternative<double>(kind_); }
  const Kind& kind() const { return kind_; }

  friend bool operator==(const TimeFunction&, const TimeFunction&) = default;

 private:
  Kind kind_ = 0.0;
};

/// Why the samples are no function of time (none, unsorted or repeated times, different counts, not finite); empty if
/// they are one. `first_bad`, if given, gets the index of the first bad row.
std::string why_invalid(const Samples& samples, std::size_t* first_bad = nullptr);

}  // namespace muldi::base
