// Values that belong to joint coordinates: their number and dimensions follow the joint's type.
#include <algorithm>
#include <type_traits>

#include "scene/read_values.hpp"

namespace muldi::scene {
namespace {

/// The coordinates that a field applies to: forces to slides, torques to angles, others to all.
std::vector<Coordinate> coordinates_of(const CoordinateField& field) {
  std::vector<Coordinate> kinds;
  for (const Coordinate kind : field.coordinates) {
    const base::Dimension unit = kind == Coordinate::slide ? field.slide : field.angle;
    if (unit != base::dimension::none) kinds.push_back(kind);
  }
  return kinds;
}

base::Field one_of(const CoordinateField& field, Coordinate kind) {
  return {.key = field.key,
          .doc = field.doc,
          .unit = kind == Coordinate::slide ? field.slide : field.angle,
          .range = field.range};
}

std::string listed(const std::vector<Coordinate>& kinds) {
  std::string text;
  for (const Coordinate kind : kinds) {
    text += text.empty() ? "[" : ", ";
    text += kind == Coordinate::slide ? "slide" : "angle";
  }
  return text + "]";
}

bool read_one(ReadContext& context, const Node& node, const CoordinateField& field, Coordinate kind, double& value) {
  return read_value(context, node, one_of(field, kind), value);
}

bool read_one(ReadContext& context, const Node& node, const CoordinateField& field, Coordinate kind, Drive& value) {
  if (node.is_null()) return true;  // no drive of this coordinate
  return read_value(context, node, one_of(field, kind), value);
}

bool read_one(ReadContext& context, const Node& node, const CoordinateField&, Coordinate kind,
              std::optional<Stops>& value) {
  if (node.is_null()) return true;  // no stops of this coordinate
  if (!node.is_map()) {
    context.error(node.mark, "needs {range: [low, high], stiffness, damping}, got " + shown(node));
    return false;
  }
  const std::size_t n_errors = context.diagnostics().size();
  FieldReader reader(context, node);
  describe_stops(kind, value.emplace(), reader);
  reader.finish();
  if (context.diagnostics().size() != n_errors) return false;
  if (value->range[0] < value->range[1]) return true;
  const ReadContext::Scope scope(context, "range");
  context.error(node.find("range")->mark, "needs [low, high] with low < high");
  return false;
}

template <class T>
bool read_one(ReadContext& context, const Node& node, const CoordinateField& field, Coordinate kind,
              std::optional<T>& value) {
  if (node.is_null()) return true;  // this coordinate is free
  return read_value(context, node, one_of(field, kind), value.emplace());
}

bool read_one(ReadContext& context, const Node& node, const CoordinateField& field, Coordinate kind,
              std::optional<Bounds>& value) {
  if (node.is_null()) return true;
  Bounds& bounds = value.emplace();
  if (!read_value(context, node, one_of(field, kind), bounds)) return false;
  if (!bounds[0] || !bounds[1] || *bounds[0] <= *bounds[1]) return true;
  context.error(node.mark, "needs [low, high] with low <= high");
  return false;
}

template <class T>
void read_all(ReadContext& context, const Node& node, const CoordinateField& field, std::vector<T>& values) {
  const std::vector<Coordinate> kinds = coordinates_of(field);
  if (kinds.empty()) {
    const bool slides = field.slide != base::dimension::none;
    const bool angles = field.angle != base::dimension::none;
    const char* what = slides && angles ? "coordinate" : slides ? "slide" : "angle";
    context.error(node.mark, std::string("this type of joint has no ") + what);
    return;
  }
  values.assign(kinds.size(), T{});
  constexpr bool are_lists = std::is_same_v<T, std::optional<Bounds>>;
  if (node.is_sequence() && !(are_lists && kinds.size() == 1)) {
    if (node.items.size() != kinds.size()) {
      context.error(node.mark, "needs " + listed(kinds) + ", got " + shown(node));
      return;
    }
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      const ReadContext::Scope scope(context, i);
      read_one(context, node.items[i], field, kinds[i], values[i]);
    }
    return;
  }
  const bool alike = (field.shared || kinds.size() == 1) &&
                     std::all_of(kinds.begin(), kinds.end(), [&](Coordinate kind) { return kind == kinds[0]; });
  if (!alike) {
    context.error(node.mark, "needs " + listed(kinds) + ", got " + shown(node));
    return;
  }
  if (read_one(context, node, field, kinds[0], values[0])) values.assign(kinds.size(), values[0]);
}

/// The kinds of the coordinates of a joint; an error if there is none of this name. False: read no values of it.
template <class T>
bool find_coordinates(ReadContext& context, Entry<T>& entry) {
  const Named<Joint>& joints = context.scene().joints;
  const Entry<Joint>* joint = joints.find(entry.name);
  if (joint == nullptr) {
    context.add(error_at(entry.origin,
                         "no joint " + base::in_quotes(entry.name) + base::did_you_mean(entry.name, joints.names())));
    return false;
  }
  const auto kinds = joint->value.coordinates();
  entry.value.coordinates.assign(kinds.begin(), kinds.end());
  return !context.failed(joint->origin.path + ".type");
}

/// The values of an entry that knows its joint's coordinates; `describe` makes the field of all of them.
template <class Describe, class T>
bool read_values(ReadContext& context, const Node& node, Describe describe, const base::Field& field, T& value) {
  read_all(context, node, describe(field.doc, value.coordinates), value.values);
  return true;
}

}  // namespace

void read_coordinates(ReadContext& context, const Node& node, const CoordinateField& field,
                      std::vector<double>& values) {
  read_all(context, node, field, values);
}

void read_coordinates(ReadContext& context, const Node& node, const CoordinateField& field,
                      std::vector<Drive>& values) {
  read_all(context, node, field, values);
}

void read_coordinates(ReadContext& context, const Node& node, const CoordinateField& field,
                      std::vector<std::optional<Stops>>& values) {
  read_all(context, node, field, values);
}

bool prepare(ReadContext& context, Entry<JointState>& state) { return find_coordinates(context, state); }
bool prepare(ReadContext& context, Entry<JointPosition>& entry) { return find_coordinates(context, entry); }
bool prepare(ReadContext& context, Entry<JointVelocity>& entry) { return find_coordinates(context, entry); }
bool prepare(ReadContext& context, Entry<JointRange>& entry) { return find_coordinates(context, entry); }
bool prepare(ReadContext& context, Entry<JointTrajectory>& entry) { return find_coordinates(context, entry); }
bool prepare(ReadContext& context, Entry<JointMomentum>& momentum) { return find_coordinates(context, momentum); }

bool read_value(ReadContext& context, const Node& node, const base::Field& field, JointMomentum& value) {
  return read_values(context, node, momentum_field, field, value);
}
bool read_value(ReadContext& context, const Node& node, const base::Field& field, JointPosition& value) {
  return read_values(context, node, position_field, field, value);
}
bool read_value(ReadContext& context, const Node& node, const base::Field& field, JointVelocity& value) {
  return read_values(context, node, velocity_field, field, value);
}
bool read_value(ReadContext& context, const Node& node, const base::Field& field, JointRange& value) {
  return read_values(context, node, position_field, field, value);
}
bool read_value(ReadContext& context, const Node& node, const base::Field& field, JointTrajectory& value) {
  return read_values(context, node, position_field, field, value);
}

}  // namespace muldi::scene
