#include "scene/read_values.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace muldi::scene {
namespace {

bool in_range(const base::Range& range, double value) {
  const bool above = range.min_open ? value > range.min : value >= range.min;
  const bool below = range.max_open ? value < range.max : value <= range.max;
  return above && below;
}

}  // namespace

bool read_value(ReadContext& context, const Node& node, const base::Field& field, double& value) {
  if (!node.is_scalar()) {
    context.error(node.mark, "needs a number, got " + shown(node));
    return false;
  }
  const base::QuantityResult read = base::parse_quantity(node.text, field.unit, context.units());
  if (!read) {
    context.error(node.mark, read.error);
    return false;
  }
  if (!in_range(field.range, read.value)) {
    context.error(node.mark, "must be " + range_text(field.range) + ", got " + shown(node));
    return false;
  }
  value = read.value;
  return true;
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, int& value) {
  const std::optional<double> number = node.is_scalar() ? base::parse_number(node.text) : std::nullopt;
  if (!number || *number != std::floor(*number) || std::abs(*number) > 1e9) {
    context.error(node.mark, "needs a whole number, got " + shown(node));
    return false;
  }
  if (!in_range(field.range, *number)) {
    context.error(node.mark, "must be " + range_text(field.range) + ", got " + shown(node));
    return false;
  }
  value = static_cast<int>(*number);
  return true;
}

bool read_value(ReadContext& context, const Node& node, const base::Field&, std::string& value) {
  if (!node.is_scalar() || node.text.empty()) {
    context.error(node.mark, "needs text, got " + shown(node));
    return false;
  }
  value = node.text;
  return true;
}

bool read_value(ReadContext& context, const Node& node, const base::Field&, base::UnitSystem& value) {
  if (!node.is_map()) {
    context.error(node.mark, "needs a map such as {length: m, mass: kg, time: s, current: A}, got " + shown(node));
    return false;
  }
  const std::size_t n_errors = context.diagnostics().size();
  const base::UnitSystem usual;
  std::string names[4] = {usual.length(), usual.mass(), usual.time(), usual.current()};
  const char* keys[4] = {"length", "mass", "time", "current"};
  FieldReader reader(context, node);
  for (int i = 0; i < 4; ++i) {
    reader(base::Field{.key = keys[i], .doc = "unit of bare numbers", .need = base::Need::optional}, names[i]);
    const Node* name = node.find(keys[i]);
    if (name == nullptr || !name->is_scalar()) continue;
    std::string error;
    base::UnitSystem::make(i == 0 ? names[0] : usual.length(), i == 1 ? names[1] : usual.mass(),
                           i == 2 ? names[2] : usual.time(), i == 3 ? names[3] : usual.current(), error);
    const ReadContext::Scope scope(context, keys[i]);
    if (!error.empty()) context.error(name->mark, std::move(error));
  }
  reader.finish();
  if (context.diagnostics().size() != n_errors) return false;
  std::string error;
  value = base::UnitSystem::make(names[0], names[1], names[2], names[3], error);
  return error.empty();
}

bool read_numbers(ReadContext& context, const Node& node, const base::Field& field, std::span<double> values) {
  if (!node.is_sequence() || node.items.size() != values.size()) {
    context.error(node.mark, "needs a list of " + std::to_string(values.size()) + " numbers, got " + shown(node));
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const ReadContext::Scope scope(context, i);
    good = read_value(context, node.items[i], field, values[i]) && good;
  }
  return good;
}

std::optional<std::size_t> read_word(ReadContext& context, const Node& node, const std::vector<std::string>& words) {
  const auto found = node.is_scalar() ? std::find(words.begin(), words.end(), node.text) : words.end();
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  context.error(node.mark,
                "needs one of " + base::joined(words) + ", got " + shown(node) +
                    (node.is_scalar() && !base::nearest(node.text, words).empty() ? base::did_you_mean(node.text, words)
                                                                                  : std::string()));
  return {};
}

std::optional<std::size_t> read_component_name(ReadContext& context, const Node& node,
                                               const std::vector<std::string>& names) {
  std::vector<std::string> found;
  std::optional<std::size_t> position;
  for (std::size_t i = 0; node.is_map() && i < names.size(); ++i) {
    if (node.find(names[i]) == nullptr) continue;
    found.push_back(names[i]);
    position = i;
  }
  if (found.size() == 1) return position;
  if (found.size() > 1) {
    context.error(node.mark, "give only one of " + base::joined(found));
    return {};
  }
  std::string message = "needs a map with one of " + base::joined(names) + ", got " + shown(node);
  if (node.is_map() && !node.entries.empty()) {
    const std::string& key = node.entries.front().key;
    message += " with " + base::in_quotes(key);
    if (!base::nearest(key, names).empty()) message += base::did_you_mean(key, names);
  }
  context.error(node.mark, std::move(message));
  return {};
}

bool check_name(ReadContext& context, const Mark& mark, const std::string& name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto inner = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-'; };
  if (name == ground) {
    context.error(mark, "the name 'ground' is reserved for what does not move; choose another");
    return false;
  }
  if (!name.empty() && letter(name.front()) && std::all_of(name.begin(), name.end(), inner)) return true;
  context.error(mark, "the name " + base::in_quotes(name) +
                          " must be letters, digits, '_' and '-' and start with a letter or '_'");
  return false;
}

}  // namespace muldi::scene
