// JSON Schema (draft-07) of the scene format, from the descriptions that the reader follows.
#include "scene/schema.hpp"

#include <utility>

#include "base/text.hpp"
#include "scene/orientation.hpp"
#include "scene/read_scene.hpp"
#include "scene/schema_nodes.hpp"
#include "scene/time_functions.hpp"

namespace muldi::scene {
namespace {

template <class T>
struct Tag {};

class SchemaVisitor;
template <class T>
concept Described = requires(T& value, SchemaVisitor& visitor) {
  T::describe(value, visitor);
};

Node schema_of(Tag<double>, const base::Field& field) { return quantity(field); }
Node schema_of(Tag<int>, const base::Field& field) {
  Node node = quantity(field);
  *node.find("type") = text("integer");
  return node;
}
Node schema_of(Tag<std::string>, const base::Field&) { return typed("string"); }
Node schema_of(Tag<Inertia>, const base::Field& field);
Node schema_of(Tag<Orientation>, const base::Field& field);
Node schema_of(Tag<BodyPoint>, const base::Field& field);
Node schema_of(Tag<RecordedPoint>, const base::Field& field);
Node schema_of(Tag<InitialFrom>, const base::Field& field);
Node schema_of(Tag<Control>, const base::Field& field);
Node schema_of(Tag<Drive>, const base::Field& field);
Node schema_of(Tag<std::optional<Stops>>, const base::Field& field);
Node schema_of(Tag<JointMomentum>, const base::Field& field);
Node schema_of(Tag<fem::Interval>, const base::Field& field);
Node schema_of(Tag<Where>, const base::Field& field);
Node schema_of(Tag<SolidMaterial>, const base::Field& field);
Node schema_of(Tag<RecordedFields>, const base::Field& field);
Node schema_of(Tag<ProbePoint>, const base::Field& field);
Node schema_of(Tag<ProbeRegion>, const base::Field& field);
Node schema_of(Tag<ElectrodeName>, const base::Field& field);
Node schema_of(Tag<JointPosition>, const base::Field& field);
Node schema_of(Tag<JointVelocity>, const base::Field& field);
Node schema_of(Tag<JointRange>, const base::Field& field);
Node schema_of(Tag<JointTrajectory>, const base::Field& field);
Node schema_of(Tag<EndMomentum>, const base::Field& field);
Node schema_of(Tag<HeldControl>, const base::Field& field);
Node schema_of(Tag<GuessedControl>, const base::Field& field);
Node schema_of(Tag<Horizon>, const base::Field& field);
Node schema_of(Tag<Guess>, const base::Field& field);
template <class T>
Node schema_of(Tag<ByPoint<T>>, const base::Field& field);
template <class Type>
Node schema_of(Tag<Weighted<Type>>, const base::Field& field);
template <class... Components>
Node schema_of(Tag<std::variant<Components...>>, const base::Field& field);
Node schema_of(Tag<base::UnitSystem>, const base::Field& field);
Node schema_of(Tag<base::TimeFunction>, const base::Field& field);
template <Family family>
Node schema_of(Tag<Reference<family>>, const base::Field&) {
  return name_text();
}
template <class T, std::size_t n>
Node schema_of(Tag<std::array<T, n>>, const base::Field& field);
template <class T>
Node schema_of(Tag<std::optional<T>>, const base::Field& field);
template <class T>
Node schema_of(Tag<std::vector<T>>, const base::Field& field);
template <class T>
Node schema_of(Tag<Named<T>>, const base::Field& field);
template <class T>
requires std::is_enum_v<T> Node schema_of(Tag<T>, const base::Field&);
template <Described T>
Node schema_of(Tag<T>, const base::Field&);

/// The default of an optional field, where it is a number or a word.
Node default_of(double value) { return raw(base::number_text(value)); }
Node default_of(int value) { return raw(std::to_string(value)); }
template <class T>
Node default_of(const T& value) {
  if constexpr (std::is_enum_v<T>) {
    for (const base::Word<T>& word : words(T{})) {
      if (word.value == value) return text(word.word);
    }
  }
  return {};
}

/// Visitor that collects the properties of an object.
class SchemaVisitor {
 public:
  template <class T>
  void operator()(const base::Field& field, T& value) {
    const bool needed = field.need == base::Need::required;
    Node node = schema_of(Tag<std::remove_const_t<T>>{}, field);
    if (!needed) {
      Node standard = default_of(value);
      if (!standard.is_null()) node.with("default", std::move(standard));
    }
    if (field.unit != base::dimension::none) node.with("x-unit", text(base::UnitSystem().unit_name(field.unit)));
    add(field.key, field.doc, std::move(node), needed);
  }

  template <class T>
  void operator()(const CoordinateField& field, std::vector<T>&) {
    Node one = schema_of(Tag<T>{}, base::Field{.key = field.key, .doc = field.doc, .range = field.range});
    const base::UnitSystem usual;
    std::vector<std::string> units;
    for (const base::Dimension unit : {field.slide, field.angle}) {
      if (unit != base::dimension::none) units.push_back(usual.unit_name(unit));
    }
    Node node = any_of({one, list_of(std::move(one))});
    node.with("x-unit", text(base::joined(units, " or ")));
    add(field.key, field.doc, std::move(node), false);
  }

  template <class... Components>
  void operator()(const base::Choice& choice, std::variant<Components...>&) {
    const bool needed = choice.need == base::Need::required;
    const std::string_view names[] = {Components::name...};
    Node options = choices({{Components::name, Components::doc}...});
    if (!needed) options.with("default", text(names[0]));
    add(choice.key, choice.doc, std::move(options), needed);
    // Without the key the condition of the first component must hold, so that it does not ask for the key.
    (add_component<Components>(choice.key, needed || Components::name != names[0]), ...);
  }

  Node object() {
    Node node = typed("object").with("additionalProperties", raw("false")).with("properties", std::move(properties_));
    if (!required_.items.empty()) node.with("required", std::move(required_));
    if (!conditions_.items.empty()) node.with("allOf", std::move(conditions_));
    return node;
  }

 private:
  void add(std::string_view key, std::string_view doc, Node node, bool needed) {
    if (properties_.find(key) == nullptr) {
      node.entries.insert(node.entries.begin(), {.key = "description", .mark = {}, .value = text(doc)});
      properties_.with(std::string(key), std::move(node));
    }
    if (needed) required_.items.push_back(text(key));
  }

  /// The fields of a component stand beside the key that names it; those that it needs are asked for by a condition,
  /// which holds without the key where it is not `with_key`.
  template <class Component>
  void add_component(std::string_view key, bool with_key) {
    Component component;
    Node outer_required = std::exchange(required_, Node::sequence());
    Component::describe(component, *this);
    Node needed = std::exchange(required_, std::move(outer_required));
    if (needed.items.empty()) return;
    Node named = Node::map().with(std::string(key), Node::map().with("const", text(Component::name)));
    Node condition = Node::map().with("properties", std::move(named));
    if (with_key) condition.with("required", Node::sequence({text(key)}));
    conditions_.items.push_back(
        Node::map().with("if", std::move(condition)).with("then", Node::map().with("required", std::move(needed))));
  }

  Node properties_ = Node::map();
  Node required_ = Node::sequence();
  Node conditions_ = Node::sequence();
};

template <class Describe>
Node object_of(Describe describe) {
  SchemaVisitor visitor;
  describe(visitor);
  return visitor.object();
}

template <Described T>
Node schema_of(Tag<T>, const base::Field&) {
  T value;
  return object_of([&](SchemaVisitor& visitor) { T::describe(value, visitor); });
}

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

template <class T, std::size_t n>
Node schema_of(Tag<std::array<T, n>>, const base::Field& field) {
  Node item = schema_of(Tag<T>{}, field);
  return list_of(is_optional<T> ? any_of({std::move(item), typed("null")}) : std::move(item), n);
}
template <class T>
Node schema_of(Tag<std::optional<T>>, const base::Field& field) {
  return schema_of(Tag<T>{}, field);
}
template <class T>
Node schema_of(Tag<std::vector<T>>, const base::Field& field) {
  return list_of(schema_of(Tag<T>{}, field));
}
template <class T>
Node schema_of(Tag<Named<T>>, const base::Field& field) {
  Node names = Node::map().with("pattern", text(name_pattern)).with("not", Node::map().with("const", text(ground)));
  return Node::map()
      .with("type", Node::sequence({text("object"), text("null")}))
      .with("propertyNames", std::move(names))
      .with("additionalProperties", schema_of(Tag<T>{}, field));
}
template <class T>
requires std::is_enum_v<T> Node schema_of(Tag<T>, const base::Field&) {
  std::vector<std::pair<std::string_view, std::string_view>> known;
  for (const base::Word<T>& word : words(T{})) known.emplace_back(word.word, word.doc);
  return choices(known);
}

/// One component of a variant, see read_component().
template <class Component>
Node schema_of_component(const base::Field& field) {
  if constexpr (requires { Component::named_by_field; }) {
    return schema_of<Component>(Tag<Component>{}, field);
  } else {
    return object_of([](SchemaVisitor& visitor) {
      Component component;
      visitor(base::Field{.key = Component::name, .doc = Component::doc}, component);
    });
  }
}
template <class... Components>
Node schema_of(Tag<std::variant<Components...>>, const base::Field& field) {
  return any_of({schema_of_component<Components>(field)...});
}

Node schema_of(Tag<fem::Interval>, const base::Field& field) {
  return schema_of(Tag<std::array<std::optional<double>, 2>>{}, field);
}
Node schema_of(Tag<Where>, const base::Field&) { return Node::map().with("$ref", text("#/definitions/where")); }
Node schema_of(Tag<SolidMaterial>, const base::Field& field) {
  return any_of({name_text(), schema_of(Tag<Named<MaterialName>>{}, field)});
}
Node schema_of(Tag<RecordedFields>, const base::Field& field) {
  return any_of(
      {schema_of<RecordedFields>(Tag<RecordedFields>{}, field), schema_of(Tag<std::vector<SolidField>>{}, field)});
}
Node schema_of(Tag<ProbePoint>, const base::Field&) { return typed("string").with("pattern", text("[@.]")); }
Node schema_of(Tag<ProbeRegion>, const base::Field& field) {
  return any_of({schema_of<ProbeRegion>(Tag<ProbeRegion>{}, field), typed("string").with("pattern", text("@"))});
}
Node schema_of(Tag<ElectrodeName>, const base::Field&) { return typed("string").with("pattern", text("\\.")); }

/// A value for each coordinate: one alone, or a list.
Node by_coordinate(const Node& one) { return any_of({one, list_of(any_of({one, typed("null")}))}); }
Node schema_of(Tag<JointPosition>, const base::Field& field) { return by_coordinate(quantity(field)); }
Node schema_of(Tag<JointVelocity>, const base::Field& field) { return by_coordinate(quantity(field)); }
Node schema_of(Tag<JointRange>, const base::Field& field) { return by_coordinate(schema_of(Tag<Bounds>{}, field)); }
Node schema_of(Tag<JointTrajectory>, const base::Field& field) {
  return by_coordinate(schema_of(Tag<base::TimeFunction>{}, field));
}
Node schema_of(Tag<EndMomentum>, const base::Field& field) {
  return any_of({Node::map().with("enum", Node::sequence({text("rest"), text("free")})),
                 schema_of(Tag<Named<JointMomentum>>{}, field)});
}
Node schema_of(Tag<HeldControl>, const base::Field& field) { return quantity(field); }
Node schema_of(Tag<GuessedControl>, const base::Field& field) { return schema_of(Tag<base::TimeFunction>{}, field); }
Node schema_of(Tag<Horizon>, const base::Field& field) {
  return any_of({quantity(field), schema_of<Horizon>(Tag<Horizon>{}, field)});
}
Node schema_of(Tag<Guess>, const base::Field& field) {
  return any_of({Node::map().with("enum", Node::sequence({text("zero"), text("scene"), text("straight")})),
                 form("simulate", schema_of(Tag<Named<GuessedControl>>{}, field),
                      "forward run under functions of time by control"),
                 form("from", typed("string"), "earlier result of optimise, of any step, finished or not"),
                 form("random", schema_of(Tag<RandomGuesses>{}, field),
                      "forward runs under random admissible controls; the best solution is taken")});
}
template <class T>
Node schema_of(Tag<ByPoint<T>>, const base::Field& field) {
  return typed("object")
      .with("propertyNames", schema_of(Tag<RecordedPoint>{}, field))
      .with("additionalProperties", schema_of(Tag<T>{}, field));
}
template <class Type>
Node schema_of(Tag<Weighted<Type>>, const base::Field& field) {
  base::Field weight = field;
  weight.range = base::non_negative;
  Weighted<Type> value;
  return any_of(
      {quantity(weight), object_of([&](SchemaVisitor& visitor) { Weighted<Type>::visit_all(value, visitor); })});
}

Node schema_of(Tag<Inertia>, const base::Field& field) {
  const Node moments = schema_of(Tag<Vec3>{}, field);
  return any_of({moments, list_of(moments, 3)});
}
Node schema_of(Tag<Orientation>, const base::Field& field) { return schema_of(Tag<OrientationForm>{}, field); }
Node schema_of(Tag<BodyPoint>, const base::Field& field) {
  return any_of({name_text(), schema_of(Tag<Vec3>{}, field)});
}
Node schema_of(Tag<RecordedPoint>, const base::Field&) {
  return typed("string").with("pattern", text("^[A-Za-z_][A-Za-z0-9_-]*\\.[A-Za-z_][A-Za-z0-9_-]*$"));
}
Node schema_of(Tag<InitialFrom>, const base::Field&) {
  return any_of({Node::map().with("enum", Node::sequence({text("scene"), text("static_equilibrium")})),
                 typed("string").with("pattern", text("\\.h5$"))});
}
Node schema_of(Tag<Control>, const base::Field& field) {
  Node properties = Node::map();
  for (const auto& word : words(ControlQuantity{})) {
    Node function = Node::map()
                        .with("description", text(word.doc))
                        .with("allOf", Node::sequence({schema_of(Tag<base::TimeFunction>{}, field)}))
                        .with("x-unit", text(base::UnitSystem().unit_name(dimension_of(word.value))));
    properties.with(std::string(word.word), std::move(function));
  }
  return typed("object")
      .with("additionalProperties", raw("false"))
      .with("minProperties", raw("1"))
      .with("maxProperties", raw("1"))
      .with("properties", std::move(properties));
}
Node schema_of(Tag<Drive>, const base::Field& field) {
  Node control = name_text();
  control.with("description", text("name of a control"));
  Node by_control = typed("object")
                        .with("additionalProperties", raw("false"))
                        .with("properties", Node::map().with("control", std::move(control)))
                        .with("required", Node::sequence({text("control")}));
  return any_of({std::move(by_control), schema_of(Tag<base::TimeFunction>{}, field), typed("null")});
}
Node schema_of(Tag<std::optional<Stops>>, const base::Field&) {
  Stops stops;
  return any_of(
      {object_of([&](SchemaVisitor& visitor) { describe_stops(Coordinate::slide, stops, visitor); }), typed("null")});
}
Node schema_of(Tag<JointMomentum>, const base::Field& field) {
  return any_of({quantity(field), list_of(quantity(field))});
}
Node schema_of(Tag<base::UnitSystem>, const base::Field&) {
  Node properties = Node::map();
  for (const char* key : {"length", "mass", "time", "current"}) {
    properties.with(key, typed("string").with("description", text(std::string("unit of ") + key)));
  }
  return typed("object").with("additionalProperties", raw("false")).with("properties", std::move(properties));
}
Node schema_of(Tag<base::TimeFunction>, const base::Field&) {
  return Node::map().with("$ref", text("#/definitions/function_of_time"));
}

Node function_of_time() {
  const base::Field plain{.key = {}, .doc = {}};
  const Node rows = list_of(list_of(quantity(plain), 2)).with("minItems", raw("1"));
  base::Ramp ramp;
  base::Sine sine;
  return any_of({quantity(plain), form("steps", rows, "[time, value] rows; each value holds until the next time"),
                 form("table", rows, "[time, value] rows; straight lines between them"),
                 form("ramp", object_of([&](auto& visitor) { describe_ramp(base::dimension::none, ramp, visitor); }),
                      "from one value to another"),
                 form("sine", object_of([&](auto& visitor) { describe_sine(base::dimension::none, sine, visitor); }),
                      "offset + amplitude sin(2 pi frequency t + phase)"),
                 schema_of(Tag<ExpressionForm>{}, plain), schema_of(Tag<FileForm>{}, plain)});
}

Node where_on_a_solid() {
  Node node = schema_of(Tag<base::VariantOf<fem::SelectorTypes>>{}, base::Field{.key = {}, .doc = {}});
  std::vector<Node>& options = node.find("anyOf")->items;
  options.insert(options.begin(), typed("string").with("description", text("name of a face or of a set, or `all`")));
  return node;
}

}  // namespace

Node schema_tree() {
  Node tree = Node::map()
                  .with("$schema", text("http://json-schema.org/draft-07/schema#"))
                  .with("title", text("muldi-sim scene"))
                  .with("description", text("A scene of muldi-sim, format version " + std::to_string(format_version)));
  Node scene = schema_of(Tag<Scene>{}, base::Field{.key = {}, .doc = {}});
  for (MapEntry& entry : scene.entries) tree.entries.push_back(std::move(entry));
  return tree.with("definitions",
                   Node::map().with("function_of_time", function_of_time()).with("where", where_on_a_solid()));
}

std::string schema_text() { return to_json(schema_tree()); }

}  // namespace muldi::scene
