#include "scene/node.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "base/text.hpp"

namespace muldi::scene {
namespace {

std::string in_double_quotes(std::string_view text) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (c == '\n') {
      result += "\\n";
    } else if (c == '\t') {
      result += "\\t";
    } else if (byte < 0x20) {
      result += "\\u00";
      result += digits[byte >> 4];
      result += digits[byte & 15];
    } else {
      result += c;
    }
  }
  return result + "\"";
}

std::string scalar_text(const Node& node) { return node.quoted ? in_double_quotes(node.text) : node.text; }

/// The node on one line.
std::string flow(const Node& node) {
  switch (node.kind) {
    case Node::Kind::null:
      return "~";
    case Node::Kind::scalar:
      return scalar_text(node);
    case Node::Kind::sequence: {
      std::vector<std::string> items;
      for (const Node& item : node.items) items.push_back(flow(item));
      return "[" + base::joined(items) + "]";
    }
    case Node::Kind::map:
      break;
  }
  std::vector<std::string> entries;
  for (const MapEntry& entry : node.entries) entries.push_back(entry.key + ": " + flow(entry.value));
  return "{" + base::joined(entries) + "}";
}

bool holds_map(const Node& map) {
  return std::any_of(map.entries.begin(), map.entries.end(), [](const MapEntry& e) { return e.value.is_map(); });
}

void append_block(std::string& text, const Node& map, std::size_t indent) {
  const std::size_t longest_line = 100;
  for (const MapEntry& entry : map.entries) {
    text.append(indent, ' ');
    text += entry.key + ":";
    if (entry.value.is_map() && !entry.value.entries.empty()) {
      const std::string line = holds_map(entry.value) ? std::string() : flow(entry.value);
      if (line.empty() || indent + entry.key.size() + line.size() > longest_line) {
        text += '\n';
        append_block(text, entry.value, indent + 2);
        continue;
      }
    }
    text += " " + flow(entry.value) + "\n";
  }
}

void append_json(std::string& text, const Node& node, std::size_t indent) {
  const std::string next_line = "\n" + std::string(indent + 2, ' ');
  const std::string last_line = "\n" + std::string(indent, ' ');
  const bool simple = std::none_of(node.items.begin(), node.items.end(),
                                   [](const Node& item) { return item.is_map() || item.is_sequence(); });
  switch (node.kind) {
    case Node::Kind::null:
      text += "null";
      return;
    case Node::Kind::scalar:
      text += scalar_text(node);
      return;
    case Node::Kind::sequence:
      text += "[";
      for (std::size_t i = 0; i < node.items.size(); ++i) {
        text += (i > 0 ? "," : "") + (simple ? std::string(i > 0 ? " " : "") : next_line);
        append_json(text, node.items[i], indent + 2);
      }
      text += (simple ? "" : last_line) + "]";
      return;
    case Node::Kind::map:
      break;
  }
  text += "{";
  for (std::size_t i = 0; i < node.entries.size(); ++i) {
    text += (i > 0 ? "," : "") + next_line + in_double_quotes(node.entries[i].key) + ": ";
    append_json(text, node.entries[i].value, indent + 2);
  }
  text += (node.entries.empty() ? "" : last_line) + "}";
}

}  // namespace

const Node* Node::find(std::string_view key) const {
  for (const MapEntry& entry : entries) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

Node* Node::find(std::string_view key) { return const_cast<Node*>(std::as_const(*this).find(key)); }

Node Node::scalar(std::string text, bool quoted) {
  Node node;
  node.kind = Kind::scalar;
  node.text = std::move(text);
  node.quoted = quoted;
  return node;
}

Node Node::sequence() { return sequence(std::vector<Node>()); }

Node Node::sequence(std::vector<Node> items) {
  Node node;
  node.kind = Kind::sequence;
  node.items = std::move(items);
  return node;
}

Node Node::map() {
  Node node;
  node.kind = Kind::map;
  return node;
}

Node& Node::with(std::string key, Node value) {
  entries.push_back({.key = std::move(key), .mark = {}, .value = std::move(value)});
  return *this;
}

std::string shown(const Node& node) {
  switch (node.kind) {
    case Node::Kind::null:
      return "nothing";
    case Node::Kind::scalar:
      return base::in_quotes(node.text);
    case Node::Kind::sequence:
      return "a list of " + std::to_string(node.items.size());
    case Node::Kind::map:
      break;
  }
  return "a map";
}

std::string to_yaml(const Node& node) {
  if (!node.is_map()) return flow(node) + "\n";
  std::string text;
  append_block(text, node, 0);
  return text;
}

std::string to_json(const Node& node) {
  std::string text;
  append_json(text, node, 0);
  return text + "\n";
}

}  // namespace muldi::scene
