// Values of solids, and of what is recorded of them, that have a form of their own.
#include <algorithm>

#include "scene/read_values.hpp"

namespace muldi::scene {
namespace {

/// A name that must be that of an entry of the family.
template <Family family>
Reference<family> reference(ReadContext& context, const Node& node, const std::string& name) {
  Reference<family> result{.name = name, .origin = context.origin(node.mark)};
  context.references().push_back({.family = family, .name = result.name, .origin = result.origin});
  return result;
}

bool find_solid(ReadContext& context, const std::string& name, const Origin& origin) {
  const Named<Solid>& solids = context.scene().solids;
  if (solids.find(name) != nullptr) return true;
  context.add(error_at(origin, "no solid " + base::in_quotes(name) + base::did_you_mean(name, solids.names())));
  return false;
}

/// `[x, y, z]` with units.
bool read_position(ReadContext& context, const Node& node, std::string_view text, Vec3& position) {
  const auto refuse = [&] {
    context.error(node.mark, "needs solid@[x, y, z] or body.point, got " + shown(node));
    return false;
  };
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') return refuse();
  text = text.substr(1, text.size() - 2);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t comma = text.find(',');
    if ((comma == text.npos) != (i == 2)) return refuse();
    const base::QuantityResult read = base::parse_quantity(std::string(base::trimmed(text.substr(0, comma))),
                                                           base::dimension::length, context.units());
    if (!read) {
      context.error(node.mark, read.error);
      return false;
    }
    position[i] = read.value;
    if (comma != text.npos) text.remove_prefix(comma + 1);
  }
  return true;
}

}  // namespace

bool read_value(ReadContext& context, const Node& node, const base::Field& field, fem::Interval& value) {
  std::array<std::optional<double>, 2> ends;
  if (!read_value(context, node, field, ends)) return false;
  value = {.low = ends[0], .high = ends[1]};
  const bool empty = value.low && value.high && *value.low > *value.high;
  if (empty) context.error(node.mark, "needs [low, high] with low <= high");
  return !empty;
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, Where& value) {
  value.origin = context.origin(node.mark);
  if (node.is_scalar() && !node.text.empty()) {
    if (node.text == fem::SelectAll::name) {
      value.selector = fem::SelectAll{};
    } else {
      value.selector = fem::SelectFace{.face = node.text};
    }
    return true;
  }
  if (!node.is_map()) {
    context.error(
        node.mark,
        "needs the name of a face, `all`, or a map with one of face, box, plane, set, point, part, got " + shown(node));
    return false;
  }
  base::VariantOf<fem::SelectorTypes> chosen;
  if (!read_value(context, node, field, chosen)) return false;
  std::visit([&](auto& selector) { value.selector = std::move(selector); }, chosen);
  const auto* plane = std::get_if<fem::SelectPlane>(&value.selector);
  if (plane != nullptr && plane->plane == fem::PlaneAt{}) {
    context.error(node.mark, "the plane needs one of x, y, z");
    return false;
  }
  return true;
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, SolidMaterial& value) {
  value.origin = context.origin(node.mark);
  if (node.is_scalar()) return read_value(context, node, field, value.whole);
  if (node.is_map() && !node.entries.empty()) return read_value(context, node, field, value.parts);
  context.error(node.mark, "needs the name of a material or {part: material}, got " + shown(node));
  return false;
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, RecordedFields& value) {
  const bool good = node.is_sequence() ? read_value(context, node, field, value.fields)
                                       : read_value<RecordedFields>(context, node, field, value);
  if (!good) return false;
  for (std::size_t i = 0; i < value.fields.size(); ++i) {
    const auto end = value.fields.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(value.fields.begin(), end, value.fields[i]) == end) continue;
    const Node* list = node.is_sequence() ? &node : node.find("fields");
    context.error(list->items[i].mark, base::in_quotes(list->items[i].text) + " stands twice");
    return false;
  }
  return true;
}

bool read_value(ReadContext& context, const Node& node, const base::Field&, ProbePoint& value) {
  value.origin = context.origin(node.mark);
  const std::size_t at = node.text.find('@');
  const std::size_t dot = node.text.find('.');
  if (node.is_scalar() && at != node.text.npos && at > 0) {
    value.solid = reference<Family::solid>(context, node, node.text.substr(0, at));
    return read_position(context, node, std::string_view(node.text).substr(at + 1), value.at);
  }
  if (!node.is_scalar() || dot == node.text.npos || dot == 0) {
    context.error(node.mark, "needs solid@[x, y, z] or body.point, got " + shown(node));
    return false;
  }
  value.body = reference<Family::body>(context, node, node.text.substr(0, dot));
  value.point = {.name = node.text.substr(dot + 1), .position = {}, .origin = value.origin};
  return true;
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, ProbeRegion& value) {
  if (node.is_map()) return read_value<ProbeRegion>(context, node, field, value);
  const std::size_t at = node.text.find('@');
  if (!node.is_scalar() || at == node.text.npos || at == 0 || at + 1 == node.text.size()) {
    context.error(node.mark, "needs solid@face or {solid, where}, got " + shown(node));
    return false;
  }
  value.solid = reference<Family::solid>(context, node, node.text.substr(0, at));
  value.where = {.selector = fem::SelectFace{.face = node.text.substr(at + 1)}, .origin = context.origin(node.mark)};
  return true;
}

bool read_value(ReadContext& context, const Node& node, const base::Field&, ElectrodeName& value) {
  const std::size_t dot = node.text.find('.');
  if (!node.is_scalar() || dot == node.text.npos || dot == 0 || dot + 1 == node.text.size()) {
    context.error(node.mark, "needs solid.electrode, got " + shown(node));
    return false;
  }
  value.solid = reference<Family::solid>(context, node, node.text.substr(0, dot));
  value.name = node.text.substr(dot + 1);
  return true;
}

bool prepare(ReadContext& context, Entry<SolidVelocity>& velocity) {
  return find_solid(context, velocity.name, velocity.origin);
}
bool prepare(ReadContext& context, Entry<RecordedFields>& fields) {
  const Named<Solid>& solids = context.scene().solids;
  const Named<Muscle>& muscles = context.scene().muscles;
  if (solids.find(fields.name) != nullptr || muscles.find(fields.name) != nullptr) return true;
  std::vector<std::string> known = solids.names();
  for (std::string& name : muscles.names()) known.push_back(std::move(name));
  context.add(error_at(fields.origin,
                       "no solid or muscle " + base::in_quotes(fields.name) + base::did_you_mean(fields.name, known)));
  return false;
}

bool prepare(ReadContext& context, const Node& node, Condition& value) {
  value.origin = context.origin(node.mark);
  return true;
}
bool prepare(ReadContext& context, const Node& node, Electrode& value) {
  value.origin = context.origin(node.mark);
  return true;
}
bool prepare(ReadContext& context, const Node& node, SolidAttachment& value) {
  value.origin = context.origin(node.mark);
  return true;
}

}  // namespace muldi::scene
