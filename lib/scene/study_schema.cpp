// JSON Schema (draft-07) of study files, from the descriptions that the reader follows.
#include "scene/read_scene.hpp"
#include "scene/schema_nodes.hpp"
#include "scene/study.hpp"

namespace muldi::scene {
namespace {

Node value_node() { return Node::map().with("type", Node::sequence({text("number"), text("string")})); }

class StudySchema;
template <class T>
Node object_of(T value = {});

Node node_of(const base::Field& field, const int&) {
  Node node = quantity(field);
  *node.find("type") = text("integer");
  return node;
}
Node node_of(const base::Field& field, const double&) {
  Node node = quantity(field);
  *node.find("type") = text("number");
  return node;
}
/// Bounds are texts with units or numbers; names are texts.
Node node_of(const base::Field& field, const std::string&) {
  return field.key == "min" || field.key == "max" || field.key == "start" ? value_node() : typed("string");
}
template <class T>
Node node_of(const base::Field& field, const std::optional<T>&) {
  return node_of(field, T{});
}
template <class T>
requires std::is_enum_v<T> Node node_of(const base::Field&, const T&) {
  std::vector<std::pair<std::string_view, std::string_view>> known;
  for (const base::Word<T>& word : words(T{})) known.emplace_back(word.word, word.doc);
  return choices(known);
}

Node map_of(Node value) {
  return typed("object").with("minProperties", raw("1")).with("additionalProperties", std::move(value));
}
Node values_node() {
  const Node values = list_of(Node::map()).with("minItems", raw("1"));
  const Node count = typed("integer").with("minimum", raw("1"));
  Node spaced = typed("array").with("items", Node::sequence({value_node(), value_node(), count}));
  spaced.with("minItems", raw("3")).with("maxItems", raw("3"));
  Node range = typed("object").with("additionalProperties", raw("false"));
  Node scale = Node::map().with("enum", Node::sequence({text("linear"), text("logarithmic")}));
  range.with("properties", Node::map().with("min", value_node()).with("max", value_node()).with("scale", scale));
  range.with("required", Node::sequence({text("min"), text("max")}));
  return any_of({values, form("values", values, "these values"),
                 form("linspace", spaced, "[first, last, number], evenly spaced"),
                 form("logspace", spaced, "[first, last, number], evenly spaced logarithms"), std::move(range)});
}
Node node_of(const base::Field&, const SetEntries&) { return map_of(Node::map()); }
Node node_of(const base::Field&, const VariedKeys&) { return map_of(values_node()); }
Node node_of(const base::Field&, const SweepOutputs&) {
  return map_of(typed("string")).with("propertyNames", Node::map().with("pattern", text(name_pattern)));
}
Node node_of(const base::Field&, const FittedKeys&) { return map_of(object_of<FitRange>()); }
Node node_of(const base::Field&, const ComparedKeys&) {
  return map_of(any_of({object_of<Comparison>(), typed("null")}));
}

/// Collects the properties of one described struct.
class StudySchema {
 public:
  template <class T>
  void operator()(const base::Field& field, T& value) {
    Node node = node_of(field, value);
    node.entries.insert(node.entries.begin(), {.key = "description", .mark = {}, .value = text(field.doc)});
    properties_.with(std::string(field.key), std::move(node));
    if (field.need == base::Need::required) required_.items.push_back(text(field.key));
  }

  Node object() {
    Node node = typed("object").with("additionalProperties", raw("false")).with("properties", std::move(properties_));
    if (!required_.items.empty()) node.with("required", std::move(required_));
    return node;
  }

 private:
  Node properties_ = Node::map();
  Node required_ = Node::sequence();
};

template <class T>
Node object_of(T value) {
  StudySchema visitor;
  T::describe(value, visitor);
  return visitor.object();
}

}  // namespace

std::string study_schema_text() {
  const Node sweep_or_fit = Node::map().with("required", Node::sequence({text("calibrate")}));
  return to_json(Node::map()
                     .with("$schema", text("http://json-schema.org/draft-07/schema#"))
                     .with("title", text("muldi-sim study"))
                     .with("description", text("A sweep or a calibration of muldi-sim, format version " +
                                               std::to_string(study_version)))
                     .with("if", sweep_or_fit)
                     .with("then", object_of<CalibrateStudy>())
                     .with("else", object_of<SweepStudy>()));
}

}  // namespace muldi::scene
