// Functions of time: scene-format.md section 2.
#include <cmath>

#include "scene/csv.hpp"
#include "scene/input_file.hpp"
#include "scene/read_values.hpp"
#include "scene/time_functions.hpp"

namespace muldi::scene {
namespace {

using base::Samples;
using base::TimeFunction;

constexpr const char* forms = "{steps: [[t, v], ...]}, {table: [[t, v], ...]}, {ramp}, {sine}, {expression} or {file}";

/// Held values say what holds from the start on.
std::string why_not_from_start(const Samples& samples) {
  if (samples.between != Samples::Between::held || samples.times.front() <= 0.0) return {};
  return "starts at t = " + base::number_text(samples.times.front()) +
         "; held values need a first time <= 0, which says what holds before";
}

bool read_rows(ReadContext& context, const Node& node, base::Dimension unit, Samples& samples) {
  if (!node.is_sequence() || node.items.empty()) {
    context.error(node.mark, "needs a list of [time, value], got " + shown(node));
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const Node& row = node.items[i];
    const ReadContext::Scope scope(context, i);
    if (!row.is_sequence() || row.items.size() != 2) {
      context.error(row.mark, "needs [time, value], got " + shown(row));
      good = false;
      continue;
    }
    const base::Field time{.key = {}, .doc = {}, .unit = base::dimension::time};
    const base::Field value{.key = {}, .doc = {}, .unit = unit};
    const ReadContext::Scope time_scope(context, std::size_t{0});
    good = read_value(context, row.items[0], time, samples.times.emplace_back()) && good;
    good = read_value(context, row.items[1], value, samples.values.emplace_back()) && good;
  }
  if (!good) return false;
  std::size_t bad = 0;
  std::string why = base::why_invalid(samples, &bad);
  if (why.empty()) why = why_not_from_start(samples);
  if (why.empty()) return true;
  const ReadContext::Scope scope(context, bad);
  context.error(node.items[bad].mark, std::move(why));
  return false;
}

/// The factor of a unit text; 1 without text. Reports a unit of another dimension at `node`.
bool read_unit(ReadContext& context, const Node& node, const std::string& unit, base::Dimension dimension,
               base::Unit& read) {
  read = {.si = context.units().si(dimension), .dimension = dimension};
  if (unit.empty()) return true;
  const base::QuantityResult one = base::parse_quantity("1 " + unit, dimension, context.units());
  const ReadContext::Scope scope(context, "unit");
  const Node* place = node.find("unit");
  const std::optional<base::Unit> parsed = base::parse_unit(unit);
  if (one && parsed) {
    read = *parsed;
    return true;
  }
  context.error((place == nullptr ? node : *place).mark, parsed ? one.error : "unknown unit " + base::in_quotes(unit));
  return false;
}

bool read_expression(ReadContext& context, const Node& node, const base::Field& field, TimeFunction& value) {
  ExpressionForm form;
  base::Unit unit;
  if (!read_value(context, node, field, form)) return false;
  if (!read_unit(context, node, form.unit, field.unit, unit)) return false;
  std::string error;
  base::Expression expression = base::Expression::make(form.expression, error);
  const ReadContext::Scope scope(context, "expression");
  const Mark mark = node.find("expression")->mark;
  if (!error.empty()) {
    context.error(mark, std::move(error));
    return false;
  }
  const double factor = context.units().from(1.0, unit);
  if (factor != 1.0) {
    expression = base::Expression::make(base::number_text(factor) + "*(" + form.expression + ")", error);
  }
  if (!std::isfinite(expression.at(0.0))) {
    context.error(mark, "has no finite value at t = 0: " + base::in_quotes(form.expression));
    return false;
  }
  value = TimeFunction(TimeFunction::Kind(std::move(expression)));
  return true;
}

bool read_file(ReadContext& context, const Node& node, const base::Field& field, TimeFunction& value) {
  FileForm form;
  base::Unit unit;
  if (!read_value(context, node, field, form)) return false;
  if (!read_unit(context, node, form.unit, field.unit, unit)) return false;
  const ReadContext::Scope scope(context, "file");
  const Mark mark = node.find("file")->mark;
  const auto refuse = [&](std::string message) {
    context.error(mark, std::move(message));
    return false;
  };
  if (std::string why = why_not_in_folder(form.file); !why.empty()) return refuse(std::move(why));
  const std::string path = path_of_file(context.scene(), form.file);
  const InputFile file = read_named_file(path);
  if (!file.error.empty()) return refuse("cannot read " + base::in_quotes(path) + ": " + file.error);
  CsvColumns columns = read_csv(file.text, form.column);
  const auto refuse_line = [&](int line, std::string message) {
    context.error_elsewhere({.file = path, .line = line, .column = 0}, std::move(message));
    return false;
  };
  if (!columns.error.empty()) return refuse_line(columns.error_line, std::move(columns.error));
  Samples samples{
      .between = form.interpolation == Interpolation::steps ? Samples::Between::held : Samples::Between::linear,
      .times = std::move(columns.first),
      .values = std::move(columns.other)};
  for (double& sample : samples.values) sample = context.units().from(sample, unit);
  std::size_t bad = 0;
  std::string why = base::why_invalid(samples, &bad);
  if (why.empty()) why = why_not_from_start(samples);
  if (!why.empty()) return refuse_line(bad < columns.lines.size() ? columns.lines[bad] : 0, std::move(why));
  value = TimeFunction(TimeFunction::Kind(std::move(samples)));
  return true;
}

/// `{ramp: {...}}` and `{sine: {...}}`.
template <class Form, class Describe>
bool read_form(ReadContext& context, const Node& node, TimeFunction& value, Describe describe) {
  if (!node.is_map()) {
    context.error(node.mark, "needs a map, got " + shown(node));
    return false;
  }
  const std::size_t n_errors = context.diagnostics().size();
  Form form;
  FieldReader reader(context, node);
  describe(form, reader);
  reader.finish();
  value = TimeFunction(TimeFunction::Kind(form));
  return context.diagnostics().size() == n_errors;
}

}  // namespace

bool read_value(ReadContext& context, const Node& node, const base::Field& field, TimeFunction& value) {
  if (node.is_scalar()) {
    double constant = 0.0;
    const bool good = read_value(context, node, field, constant);
    value = TimeFunction(constant);
    return good;
  }
  if (!node.is_map()) {
    context.error(node.mark, std::string("needs a number or a function of time: ") + forms + ", got " + shown(node));
    return false;
  }
  if (node.find("expression") != nullptr) return read_expression(context, node, field, value);
  if (node.find("file") != nullptr) return read_file(context, node, field, value);
  if (node.entries.size() != 1) {
    context.error(node.mark, std::string("needs one function of time: ") + forms);
    return false;
  }
  const std::string& form = node.entries.front().key;
  const Node& content = node.entries.front().value;
  const ReadContext::Scope scope(context, form);
  if (form == "steps" || form == "table") {
    Samples samples{.between = form == "steps" ? Samples::Between::held : Samples::Between::linear};
    const bool good = read_rows(context, content, field.unit, samples);
    if (good) value = TimeFunction(TimeFunction::Kind(std::move(samples)));
    return good;
  }
  if (form == "ramp") {
    return read_form<base::Ramp>(context, content, value,
                                 [&](auto& ramp, auto& visit) { describe_ramp(field.unit, ramp, visit); });
  }
  if (form == "sine") {
    return read_form<base::Sine>(context, content, value,
                                 [&](auto& sine, auto& visit) { describe_sine(field.unit, sine, visit); });
  }
  context.error(
      node.entries.front().mark,
      "no function of time" + base::did_you_mean(form, {"steps", "table", "ramp", "sine", "expression", "file"}));
  return false;
}

}  // namespace muldi::scene
