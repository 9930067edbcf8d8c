#pragma once
/// Pieces of a JSON Schema as nodes.
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/describe.hpp"
#include "base/text.hpp"
#include "scene/node.hpp"

namespace muldi::scene {

inline constexpr const char* name_pattern = "^[A-Za-z_][A-Za-z0-9_-]*$";

inline Node text(std::string_view value) { return Node::scalar(std::string(value), true); }
inline Node raw(std::string_view value) { return Node::scalar(std::string(value), false); }
inline Node typed(std::string_view type) { return Node::map().with("type", text(type)); }
inline Node list_of(Node items) { return typed("array").with("items", std::move(items)); }
inline Node list_of(Node items, std::size_t n) {
  const std::string count = std::to_string(n);
  return list_of(std::move(items)).with("minItems", raw(count)).with("maxItems", raw(count));
}
inline Node any_of(std::vector<Node> options) { return Node::map().with("anyOf", Node::sequence(std::move(options))); }
inline Node choices(const std::vector<std::pair<std::string_view, std::string_view>>& words) {
  Node options = Node::sequence();
  for (const auto& [word, doc] : words) {
    options.items.push_back(Node::map().with("const", text(word)).with("description", text(doc)));
  }
  return Node::map().with("oneOf", std::move(options));
}
inline Node name_text() { return typed("string").with("pattern", text(name_pattern)); }

/// A number or a text with a unit.
inline Node quantity(const base::Field& field) {
  Node node = Node::map().with("type", Node::sequence({text("number"), text("string")}));
  const base::Range& range = field.range;
  if (std::isfinite(range.min)) {
    node.with(range.min_open ? "exclusiveMinimum" : "minimum", raw(base::number_text(range.min)));
  }
  if (std::isfinite(range.max)) {
    node.with(range.max_open ? "exclusiveMaximum" : "maximum", raw(base::number_text(range.max)));
  }
  return node;
}

/// An object with one key.
inline Node form(std::string_view key, Node content, std::string_view doc) {
  content.entries.insert(content.entries.begin(), {.key = "description", .mark = {}, .value = text(doc)});
  return typed("object")
      .with("additionalProperties", raw("false"))
      .with("properties", Node::map().with(std::string(key), std::move(content)))
      .with("required", Node::sequence({text(key)}));
}

}  // namespace muldi::scene
