// The table of all fields, read off the schema.
#include "scene/documentation.hpp"

#include <utility>

#include "base/text.hpp"
#include "scene/read_scene.hpp"
#include "scene/schema.hpp"

namespace muldi::scene {
namespace {

std::string text_of(const Node& schema, std::string_view key) {
  const Node* node = schema.find(key);
  return node == nullptr ? std::string() : node->text;
}

}  // namespace

std::string kind_of(const Node& schema) {
  if (const Node* reference = schema.find("$ref")) {
    return reference->text == "#/definitions/where" ? "where" : "function of time";
  }
  if (const Node* all = schema.find("allOf"); all != nullptr && schema.find("type") == nullptr) {
    return kind_of(all->items.front());
  }
  if (const Node* words = schema.find("oneOf")) {
    std::vector<std::string> known;
    for (const Node& word : words->items) known.push_back(text_of(word, "const"));
    return "one of " + base::joined(known);
  }
  if (const Node* words = schema.find("enum")) {
    std::vector<std::string> known;
    for (const Node& word : words->items) known.push_back(word.text);
    return "one of " + base::joined(known);
  }
  if (const Node* options = schema.find("anyOf")) {
    std::vector<std::string> kinds;
    for (const Node& option : options->items) kinds.push_back(kind_of(option));
    return base::joined(kinds, " or ");
  }
  const Node& type = *schema.find("type");
  if (type.is_sequence()) return type.items.front().text == "number" ? "number" : "map of names";
  if (type.text == "array") {
    const std::string count = text_of(schema, "minItems");
    return "list of " + (count.empty() || schema.find("maxItems") == nullptr ? std::string() : count + " x ") +
           kind_of(*schema.find("items"));
  }
  if (type.text == "object") return "map";
  if (type.text == "string") return schema.find("pattern") != nullptr ? "name" : "text";
  return type.text == "null" ? "~" : "whole number";
}

std::string range_of(const Node& schema) {
  std::vector<std::string> bounds;
  for (const auto& [key, sign] : {std::pair("minimum", ">= "), std::pair("exclusiveMinimum", "> "),
                                  std::pair("maximum", "<= "), std::pair("exclusiveMaximum", "< ")}) {
    if (const Node* bound = schema.find(key)) bounds.push_back(sign + bound->text);
  }
  return base::joined(bounds, " and ");
}

bool is_required(const Node& object, const std::string& key) {
  const Node* required = object.find("required");
  if (required == nullptr) return false;
  for (const Node& item : required->items) {
    if (item.text == key) return true;
  }
  return false;
}

namespace {

void append(std::vector<DocumentedField>& rows, const Node& object, const std::string& path);

/// The fields below one field.
void append_below(std::vector<DocumentedField>& rows, const Node& schema, const std::string& path) {
  if (schema.find("properties") != nullptr) append(rows, schema, path);
  if (const Node* items = schema.find("items")) append_below(rows, *items, path + "[]");
  if (const Node* named = schema.find("additionalProperties"); named != nullptr && named->is_map()) {
    append_below(rows, *named, path + ".<name>");
  }
  if (const Node* options = schema.find("anyOf")) {
    for (std::size_t i = 0; i < options->items.size(); ++i) {
      const Node& option = options->items[i];
      if (i == 0 || option.find("properties") != nullptr) append_below(rows, option, path);
    }
  }
}

void append(std::vector<DocumentedField>& rows, const Node& object, const std::string& path) {
  for (const MapEntry& property : object.find("properties")->entries) {
    const Node& schema = property.value;
    const std::string below = path.empty() ? property.key : path + "." + property.key;
    rows.push_back({.path = below,
                    .kind = kind_of(schema),
                    .unit = text_of(schema, "x-unit"),
                    .range = range_of(schema),
                    .required = is_required(object, property.key),
                    .doc = text_of(schema, "description")});
    append_below(rows, schema, below);
  }
}

}  // namespace

std::vector<DocumentedField> documented_fields() {
  std::vector<DocumentedField> rows;
  const Node tree = schema_tree();
  append(rows, tree, {});
  append_below(rows, *tree.find("definitions")->find("where"), "where");
  return rows;
}

}  // namespace muldi::scene
