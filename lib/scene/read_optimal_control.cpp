// Values of the section `optimal_control:` that have a form of their own.
#include "scene/read_values.hpp"

namespace muldi::scene {
namespace {

/// Gives an entry the dimension of the control of its name. False if it cannot be read without it.
template <class T>
bool find_unit(ReadContext& context, Entry<T>& entry) {
  const Named<Control>& controls = context.scene().controls;
  const Entry<Control>* control = controls.find(entry.name);
  if (control == nullptr) {
    context.add(error_at(
        entry.origin, "no control " + base::in_quotes(entry.name) + base::did_you_mean(entry.name, controls.names())));
    return false;
  }
  entry.value.unit = dimension_of(control->value.quantity);
  return !context.failed(control->origin.path);
}

template <class T>
bool find_body(ReadContext& context, const Entry<T>& entry) {
  const Named<Body>& bodies = context.scene().bodies;
  if (bodies.find(entry.name) != nullptr) return true;
  context.add(error_at(entry.origin,
                       "no body " + base::in_quotes(entry.name) + base::did_you_mean(entry.name, bodies.names())));
  return false;
}

template <class T>
bool read_in_unit_of_control(ReadContext& context, const Node& node, base::Field field, T& value) {
  field.unit = value.unit;
  return read_value(context, node, field, value.value);
}

}  // namespace

bool prepare(ReadContext& context, Entry<BodyPose>& pose) { return find_body(context, pose); }
bool prepare(ReadContext& context, Entry<Orientation>& orientation) { return find_body(context, orientation); }
bool prepare(ReadContext& context, Entry<HeldControl>& control) { return find_unit(context, control); }
bool prepare(ReadContext& context, Entry<GuessedControl>& control) { return find_unit(context, control); }
bool prepare(ReadContext& context, Entry<ControlBounds>& control) { return find_unit(context, control); }

bool prepare(ReadContext& context, const Node& node, Stage& value) {
  value.origin = context.origin(node.mark);
  return true;
}

bool prepare(ReadContext& context, const Node& node, OptimalControl& value) {
  value.origin = context.origin(node.mark);
  return true;
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, HeldControl& value) {
  return read_in_unit_of_control(context, node, field, value);
}
bool read_value(ReadContext& context, const Node& node, const base::Field& field, GuessedControl& value) {
  return read_in_unit_of_control(context, node, field, value);
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, EndMomentum& value) {
  if (node.is_map()) {
    value.kind = EndMomentum::Kind::given;
    return read_value(context, node, field, value.joints);
  }
  if (!node.is_scalar() || node.is_null()) {
    context.error(node.mark, "needs rest, free or {joint: momentum}, got " + shown(node));
    return false;
  }
  const std::optional<std::size_t> word = read_word(context, node, {"rest", "free"});
  if (!word) return false;
  value.kind = *word == 0 ? EndMomentum::Kind::rest : EndMomentum::Kind::free;
  return true;
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, Horizon& value) {
  if (node.is_map()) return read_value<Horizon>(context, node, field, value);
  if (!read_value(context, node, field, value.min)) return false;
  value.max = value.min;
  return true;
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, std::optional<Replay>& value) {
  return node.is_null() || read_value<Replay>(context, node, field, value.emplace());
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, Guess& value) {
  value.origin = context.origin(node.mark);
  const auto refuse = [&] {
    context.error(
        node.mark,
        "needs zero, scene, straight, {simulate: {control: value}}, {from: earlier.h5} or {random: {starts, seed}}, "
        "got " +
            (node.is_map() ? std::to_string(node.entries.size()) + " keys" : shown(node)));
    return false;
  };
  if (node.is_scalar()) {
    constexpr Guess::Kind kinds[] = {Guess::Kind::zero, Guess::Kind::scene, Guess::Kind::straight};
    const std::optional<std::size_t> word = read_word(context, node, {"zero", "scene", "straight"});
    if (word) value.kind = kinds[*word];
    return word.has_value();
  }
  if (!node.is_map() || node.entries.size() != 1) return refuse();
  const std::optional<std::size_t> form = read_component_name(context, node, {"simulate", "from", "random"});
  if (!form) return false;
  const MapEntry& entry = node.entries.front();
  const ReadContext::Scope scope(context, entry.key);
  if (*form == 0) {
    value.kind = Guess::Kind::simulate;
    return read_value(context, entry.value, field, value.simulate);
  }
  if (*form == 1) {
    value.kind = Guess::Kind::record;
    return read_value(context, entry.value, field, value.file);
  }
  value.kind = Guess::Kind::random;
  return read_value(context, entry.value, field, value.random);
}

}  // namespace muldi::scene
