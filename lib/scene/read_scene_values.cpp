// Values of scenes that have a form of their own.
#include <algorithm>

#include "scene/orientation.hpp"
#include "scene/read_values.hpp"

namespace muldi::scene {

bool read_value(ReadContext& context, const Node& node, const base::Field& field, Mat3& value) {
  if (!node.is_sequence() || node.items.size() != 3) {
    context.error(node.mark, "needs a list of 3 rows of 3 numbers, got " + shown(node));
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const ReadContext::Scope scope(context, i);
    good = read_value(context, node.items[i], field, value[i]) && good;
  }
  return good;
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, Inertia& value) {
  const bool is_tensor = node.is_sequence() && std::any_of(node.items.begin(), node.items.end(),
                                                           [](const Node& item) { return item.is_sequence(); });
  if (is_tensor) {
    if (node.items.size() == 3) return read_value(context, node, field, value.tensor);
  } else if (node.is_sequence() && node.items.size() == 3) {
    base::Field moments = field;
    moments.range = base::non_negative;
    Vec3 principal{};
    if (!read_value(context, node, moments, principal)) return false;
    for (std::size_t i = 0; i < 3; ++i) value.tensor[i][i] = principal[i];
    return true;
  }
  context.error(node.mark, "needs three principal moments or a 3x3 tensor, got " + shown(node));
  return false;
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, Orientation& value) {
  OrientationForm form;
  if (!read_value(context, node, field, form)) return false;
  std::string error = to_matrix(form, value.matrix);
  if (error.empty()) return true;
  context.error(node.mark, std::move(error));
  return false;
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, BodyPoint& value) {
  value.origin = context.origin(node.mark);
  if (node.is_sequence()) return read_value(context, node, field, value.position);
  if (node.is_scalar() && !base::parse_number(node.text)) return read_value(context, node, field, value.name);
  context.error(node.mark, "needs the name of a point or a list of 3 numbers, got " + shown(node));
  return false;
}

bool read_point_name(ReadContext& context, const Mark& mark, const std::string& text, RecordedPoint& value) {
  const std::size_t dot = text.find('.');
  if (dot == text.npos) {
    context.error(mark, "needs body.point, got '" + text + "'");
    return false;
  }
  value.body = {.name = text.substr(0, dot), .origin = context.origin(mark)};
  value.point = {.name = text.substr(dot + 1), .position = {}, .origin = context.origin(mark)};
  context.references().push_back({.family = Family::body, .name = value.body.name, .origin = value.body.origin});
  return true;
}

bool read_value(ReadContext& context, const Node& node, const base::Field&, RecordedPoint& value) {
  if (node.is_scalar()) return read_point_name(context, node.mark, node.text, value);
  context.error(node.mark, "needs body.point, got " + shown(node));
  return false;
}

bool read_value(ReadContext& context, const Node& node, const base::Field&, InitialFrom& value) {
  const std::string_view ending = ".h5";
  value.origin = context.origin(node.mark);
  if (node.text == "scene") {
    value.kind = InitialFrom::Kind::scene;
  } else if (node.text == "static_equilibrium") {
    value.kind = InitialFrom::Kind::static_equilibrium;
  } else if (node.text.size() > ending.size() && node.text.substr(node.text.size() - ending.size()) == ending) {
    value.kind = InitialFrom::Kind::record;
    value.file = node.text;
  } else {
    const std::string hint = base::nearest(node.text, {"scene", "static_equilibrium"}).empty()
                                 ? std::string()
                                 : base::did_you_mean(node.text, {"scene", "static_equilibrium"});
    context.error(node.mark, "needs scene, static_equilibrium or an earlier record (*.h5), got " + shown(node) + hint);
    return false;
  }
  return true;
}

bool read_value(ReadContext& context, const Node& node, const base::Field&, Control& value) {
  std::vector<std::string> known;
  for (const auto& word : words(ControlQuantity{})) known.emplace_back(word.word);
  if (!node.is_map() || node.entries.size() != 1) {
    context.error(node.mark, "needs {<quantity>: function of time} with one quantity of " + base::joined(known) +
                                 ", got " +
                                 (node.is_map() ? std::to_string(node.entries.size()) + " keys" : shown(node)));
    return false;
  }
  const MapEntry& entry = node.entries.front();
  const ReadContext::Scope scope(context, entry.key);
  const auto found = std::find(known.begin(), known.end(), entry.key);
  if (found == known.end()) {
    context.error(entry.mark, "no quantity of a control" + base::did_you_mean(entry.key, known));
    return false;
  }
  const auto& word = words(ControlQuantity{})[static_cast<std::size_t>(found - known.begin())];
  value.quantity = word.value;
  const base::Field field{.key = word.word, .doc = word.doc, .unit = dimension_of(word.value)};
  return read_value(context, entry.value, field, value.value);
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, Drive& value) {
  if (node.find("control") == nullptr) return read_value(context, node, field, value.value);
  const std::size_t n_errors = context.diagnostics().size();
  FieldReader reader(context, node);
  reader(base::Field{.key = "control", .doc = "name of a control"}, value.control);
  reader.finish();
  return context.diagnostics().size() == n_errors;
}

bool prepare(ReadContext& context, Entry<BodyVelocity>& velocity) {
  const Named<Body>& bodies = context.scene().bodies;
  if (bodies.find(velocity.name) != nullptr) return true;
  context.add(error_at(velocity.origin, "no body " + base::in_quotes(velocity.name) +
                                            base::did_you_mean(velocity.name, bodies.names())));
  return false;
}

bool prepare(ReadContext& context, const Node& node, Statics& value) {
  const Node* name = node.find("control");
  if (name == nullptr || !name->is_scalar()) return true;
  const Named<Control>& controls = context.scene().controls;
  const Entry<Control>* control = controls.find(name->text);
  if (control == nullptr) {
    const ReadContext::Scope scope(context, "control");
    context.error(name->mark,
                  "no control " + base::in_quotes(name->text) + base::did_you_mean(name->text, controls.names()));
    return false;
  }
  value.unit = dimension_of(control->value.quantity);
  return !context.failed(control->origin.path);
}

}  // namespace muldi::scene
