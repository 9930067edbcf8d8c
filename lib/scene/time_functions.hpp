#pragma once
/// The forms of a function of time in a scene, described once for the reader, the schema and the documentation.
#include <span>
#include <string>

#include "base/describe.hpp"
#include "base/time_function.hpp"

namespace muldi::scene {

/// `{from, to, start, over}` with values of dimension `unit`.
template <class Ramp, class Visit>
void describe_ramp(base::Dimension unit, Ramp& ramp, Visit& visit) {
  using namespace base;
  constexpr auto optional = Need::optional;
  visit(Field{.key = "from", .doc = "value before the ramp", .unit = unit, .need = optional}, ramp.from);
  visit(Field{.key = "to", .doc = "value after the ramp", .unit = unit}, ramp.to);
  visit(Field{.key = "start", .doc = "time at which the ramp starts", .unit = dimension::time, .need = optional},
        ramp.start);
  visit(Field{.key = "over", .doc = "how long it takes", .unit = dimension::time, .range = positive}, ramp.over);
}

/// `{amplitude, frequency, phase, offset}` with values of dimension `unit`.
template <class Sine, class Visit>
void describe_sine(base::Dimension unit, Sine& sine, Visit& visit) {
  using namespace base;
  constexpr auto optional = Need::optional;
  visit(Field{.key = "amplitude", .doc = "largest deviation from the offset", .unit = unit}, sine.amplitude);
  visit(Field{.key = "frequency", .doc = "cycles by time", .unit = dimension::frequency, .range = non_negative},
        sine.frequency);
  visit(Field{.key = "phase", .doc = "angle at t = 0", .unit = dimension::angle, .need = optional}, sine.phase);
  visit(Field{.key = "offset", .doc = "mean value", .unit = unit, .need = optional}, sine.offset);
}

enum class Interpolation { steps, linear };

inline std::span<const base::Word<Interpolation>> words(Interpolation) {
  static constexpr base::Word<Interpolation> all[] = {
      {.word = "steps", .value = Interpolation::steps, .doc = "each value holds until the next time"},
      {.word = "linear", .value = Interpolation::linear, .doc = "straight lines between the values"},
  };
  return all;
}

/// `{expression, unit}`.
struct ExpressionForm {
  std::string expression = {};
  std::string unit = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "expression", .doc = "formula of t, the time in the scene's unit"}, self.expression);
    visit(base::Field{.key = "unit", .doc = "unit of the formula's value", .need = base::Need::optional}, self.unit);
  }
};

/// `{file, column, unit, interpolation}`.
struct FileForm {
  std::string file = {};
  int column = 2;
  std::string unit = {};
  Interpolation interpolation = Interpolation::steps;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "file", .doc = "CSV file in the scene's folder or below; times in the first column"}, self.file);
    visit(Field{.key = "column",
                .doc = "column of the values, from 1",
                .range = {.min = 2.0, .max = 1e4},
                .need = optional},
          self.column);
    visit(Field{.key = "unit", .doc = "unit of the values", .need = optional}, self.unit);
    visit(Field{.key = "interpolation", .doc = "between the times"}, self.interpolation);
  }
};

}  // namespace muldi::scene
