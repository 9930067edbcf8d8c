#pragma once
/// How each type of a described field is read from a node. Every overload reports what is wrong and then leaves a
/// value that is not used.
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/describe.hpp"
#include "base/text.hpp"
#include "scene/field_reader.hpp"
#include "scene/read_context.hpp"
#include "scene/scene.hpp"

namespace muldi::scene {

// Plain values (read_values.cpp).
bool read_value(ReadContext& context, const Node& node, const base::Field& field, double& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, int& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, std::string& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, base::UnitSystem& value);
bool read_numbers(ReadContext& context, const Node& node, const base::Field& field, std::span<double> values);
/// The position of the word among `words`; nothing and an error if it is none.
std::optional<std::size_t> read_word(ReadContext& context, const Node& node, const std::vector<std::string>& words);
/// The position of the one of `names` that is a key of the map; nothing and an error if it has none or several.
std::optional<std::size_t> read_component_name(ReadContext& context, const Node& node,
                                               const std::vector<std::string>& names);
/// Whether `name` may name an entry; an error if not.
bool check_name(ReadContext& context, const Mark& mark, const std::string& name);

// Values of scenes (read_scene_values.cpp, read_time_function.cpp, read_coordinates.cpp, read_optimal_control.cpp).
bool read_value(ReadContext& context, const Node& node, const base::Field& field, Mat3& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, Inertia& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, Orientation& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, BodyPoint& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, RecordedPoint& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, InitialFrom& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, Control& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, Drive& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, base::TimeFunction& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, JointMomentum& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, fem::Interval& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, Where& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, SolidMaterial& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, RecordedFields& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, ProbePoint& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, ProbeRegion& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, ElectrodeName& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, JointPosition& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, JointVelocity& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, JointRange& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, JointTrajectory& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, EndMomentum& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, HeldControl& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, GuessedControl& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, Horizon& value);
bool read_value(ReadContext& context, const Node& node, const base::Field& field, Guess& value);
/// None where it is ~, so that an override can leave the replay out.
bool read_value(ReadContext& context, const Node& node, const base::Field& field, std::optional<Replay>& value);
/// `body.point`, as a value or as a key.
bool read_point_name(ReadContext& context, const Mark& mark, const std::string& text, RecordedPoint& value);
void read_coordinates(ReadContext& context, const Node& node, const CoordinateField& field,
                      std::vector<double>& values);
void read_coordinates(ReadContext& context, const Node& node, const CoordinateField& field, std::vector<Drive>& values);
void read_coordinates(ReadContext& context, const Node& node, const CoordinateField& field,
                      std::vector<std::optional<Stops>>& values);

/// Gives an entry what it must know of the rest of the scene before its value is read. False if the value cannot be
/// read without it; the reason has been reported.
template <class T>
bool prepare(ReadContext&, Entry<T>&) {
  return true;
}
bool prepare(ReadContext& context, Entry<JointState>& state);
bool prepare(ReadContext& context, Entry<JointMomentum>& momentum);
bool prepare(ReadContext& context, Entry<BodyVelocity>& velocity);
bool prepare(ReadContext& context, Entry<SolidVelocity>& velocity);
bool prepare(ReadContext& context, Entry<RecordedFields>& fields);
bool prepare(ReadContext& context, Entry<JointPosition>& entry);
bool prepare(ReadContext& context, Entry<JointVelocity>& entry);
bool prepare(ReadContext& context, Entry<JointRange>& entry);
bool prepare(ReadContext& context, Entry<JointTrajectory>& entry);
bool prepare(ReadContext& context, Entry<BodyPose>& pose);
bool prepare(ReadContext& context, Entry<Orientation>& orientation);
bool prepare(ReadContext& context, Entry<HeldControl>& control);
bool prepare(ReadContext& context, Entry<GuessedControl>& control);
bool prepare(ReadContext& context, Entry<ControlBounds>& control);

/// The same for a described value outside of a named section.
template <class T>
bool prepare(ReadContext&, const Node&, T&) {
  return true;
}
bool prepare(ReadContext& context, const Node& node, Statics& value);
bool prepare(ReadContext& context, const Node& node, Condition& value);
bool prepare(ReadContext& context, const Node& node, Electrode& value);
bool prepare(ReadContext& context, const Node& node, SolidAttachment& value);
bool prepare(ReadContext& context, const Node& node, Stage& value);
bool prepare(ReadContext& context, const Node& node, OptimalControl& value);

template <std::size_t n>
bool read_value(ReadContext& context, const Node& node, const base::Field& field, std::array<double, n>& value) {
  return read_numbers(context, node, field, value);
}

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

/// A list of n values; ~ where they are optional.
template <class T, std::size_t n>
bool read_value(ReadContext& context, const Node& node, const base::Field& field, std::array<T, n>& values) {
  if (!node.is_sequence() || node.items.size() != n) {
    context.error(node.mark, "needs a list of " + std::to_string(n) + ", got " + shown(node));
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < n; ++i) {
    if (is_optional<T> && node.items[i].is_null()) continue;
    const ReadContext::Scope scope(context, i);
    good = read_value(context, node.items[i], field, values[i]) && good;
  }
  return good;
}

/// An enum with words().
template <class T>
requires std::is_enum_v<T>
bool read_value(ReadContext& context, const Node& node, const base::Field&, T& value) {
  std::vector<std::string> known;
  for (const base::Word<T>& word : words(T{})) known.emplace_back(word.word);
  const std::optional<std::size_t> i = read_word(context, node, known);
  if (!i) return false;
  value = words(T{})[*i].value;
  return true;
}

template <Family family>
bool read_value(ReadContext& context, const Node& node, const base::Field& field, Reference<family>& value) {
  value.origin = context.origin(node.mark);
  if (!read_value(context, node, field, value.name)) return false;
  context.references().push_back({.family = family, .name = value.name, .origin = value.origin});
  return true;
}

template <class T>
bool read_value(ReadContext& context, const Node& node, const base::Field& field, std::optional<T>& value) {
  return read_value(context, node, field, value.emplace());
}

template <class T>
bool read_value(ReadContext& context, const Node& node, const base::Field& field, std::vector<T>& values) {
  if (!node.is_sequence()) {
    context.error(node.mark, "needs a list, got " + shown(node));
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const ReadContext::Scope scope(context, i);
    good = read_value(context, node.items[i], field, values.emplace_back()) && good;
  }
  return good;
}

/// A described type.
template <class T>
requires requires(T& value, FieldReader& reader) { T::describe(value, reader); }
bool read_value(ReadContext& context, const Node& node, const base::Field&, T& value) {
  if (!node.is_map()) {
    context.error(node.mark, "needs a map, got " + shown(node));
    return false;
  }
  const std::size_t n_errors = context.diagnostics().size();
  if (!prepare(context, node, value)) return false;
  FieldReader reader(context, node);
  T::describe(value, reader);
  reader.finish();
  return context.diagnostics().size() == n_errors;
}

/// Values by `body.point`.
template <class T>
bool read_value(ReadContext& context, const Node& node, const base::Field& field, ByPoint<T>& value) {
  if (!node.is_map()) {
    context.error(node.mark, "needs a map {body.point: value}, got " + shown(node));
    return false;
  }
  bool good = true;
  for (const MapEntry& entry : node.entries) {
    const ReadContext::Scope scope(context, entry.key);
    auto& item = value.items.emplace_back();
    item.origin = context.origin(entry.mark);
    good = read_point_name(context, entry.mark, entry.key, item.point) && good;
    good = read_value(context, entry.value, field, item.value) && good;
  }
  return good;
}

/// An objective: its weight alone, or {weight, options}.
template <class Type>
bool read_value(ReadContext& context, const Node& node, const base::Field& field, Weighted<Type>& value) {
  if (node.is_scalar()) {
    base::Field weight = field;
    weight.range = base::non_negative;
    return read_value(context, node, weight, value.weight);
  }
  if (!node.is_map()) {
    context.error(node.mark, "needs a weight or a map of options, got " + shown(node));
    return false;
  }
  const std::size_t n_errors = context.diagnostics().size();
  FieldReader reader(context, node);
  Weighted<Type>::visit_all(value, reader);
  reader.finish();
  return context.diagnostics().size() == n_errors;
}

/// The component of a variant: `{name: fields}`, or, where it says `named_by_field`, its fields with one of its name.
template <class Component>
bool read_component(ReadContext& context, const Node& node, Component& component) {
  const std::size_t n_errors = context.diagnostics().size();
  FieldReader reader(context, node);
  if constexpr (requires { Component::named_by_field; }) {
    Component::describe(component, reader);
  } else {
    reader(base::Field{.key = Component::name, .doc = Component::doc}, component);
  }
  reader.finish();
  return context.diagnostics().size() == n_errors;
}

template <class... Components>
bool read_value(ReadContext& context, const Node& node, const base::Field&, std::variant<Components...>& value) {
  const std::optional<std::size_t> chosen = read_component_name(context, node, {std::string(Components::name)...});
  if (!chosen) return false;
  std::size_t i = 0;
  bool good = true;
  ((i++ == *chosen ? void(good = read_component(context, node, value.template emplace<Components>())) : void()), ...);
  return good;
}

template <class T>
bool read_value(ReadContext& context, const Node& node, const base::Field& field, Named<T>& section) {
  if (node.is_null()) return true;  // a section without entries
  if (!node.is_map()) {
    context.error(node.mark, "needs a map of names, got " + shown(node));
    return false;
  }
  bool good = true;
  for (const MapEntry& item : node.entries) {
    const ReadContext::Scope scope(context, item.key);
    good = check_name(context, item.mark, item.key) && good;
    Entry<T>& entry = section.add({.name = item.key, .origin = context.origin(item.mark), .value = {}});
    good = prepare(context, entry) && read_value(context, item.value, field, entry.value) && good;
  }
  return good;
}

// The visitor's calls, which need the overloads above.

template <class T>
void FieldReader::operator()(const base::Field& field, T& value) {
  const Node* node = take(field.key, field.need == base::Need::required);
  if (node == nullptr || !reading_) return;
  const ReadContext::Scope scope(context_, field.key);
  read_value(context_, *node, field, value);
}

template <class T>
void FieldReader::operator()(const CoordinateField& field, T& values) {
  const Node* node = take(field.key, false);
  if (node == nullptr || !reading_) return;
  const ReadContext::Scope scope(context_, field.key);
  read_coordinates(context_, *node, field, values);
}

template <class... Components>
void FieldReader::operator()(const base::Choice& choice, std::variant<Components...>& value) {
  const std::vector<std::string> names{std::string(Components::name)...};
  const Node* node = take(choice.key, false);
  std::optional<std::size_t> chosen;
  if (node == nullptr && choice.need == base::Need::optional) {
    chosen = 0;
  } else if (node == nullptr) {
    context_.error(map_.mark, "missing key '" + std::string(choice.key) + "' (" + base::joined(names) + ")");
  } else {
    const ReadContext::Scope scope(context_, choice.key);
    chosen = read_word(context_, *node, names);
  }
  std::size_t i = 0;
  (visit_component<Components>(i++, chosen, value), ...);
  if (chosen) component_ = std::string(choice.key) + " " + names[*chosen];
}

template <class Component, class Variant>
void FieldReader::visit_component(std::size_t i, std::optional<std::size_t> chosen, Variant& value) {
  if (chosen == i) {
    Component::describe(value.template emplace<Component>(), *this);
    return;
  }
  // Keys of other components are known, but only allowed while it is open which one is meant.
  Component other;
  reading_ = false;
  foreign_ = chosen.has_value();
  Component::describe(other, *this);
  reading_ = true;
  foreign_ = false;
}

}  // namespace muldi::scene
