#include "scene/overrides.hpp"

#include <charconv>
#include <optional>
#include <utility>

#include "base/text.hpp"
#include "scene/yaml.hpp"

namespace muldi::scene {
namespace {

/// `.key` or `[index]`.
struct Step {
  std::string key;
  std::size_t index = 0;
  bool is_index = false;
};

/// The steps of `a.b[2].c`; nothing if it is no path.
std::optional<std::vector<Step>> parse_path(std::string_view path) {
  std::vector<Step> steps;
  while (!path.empty()) {
    if (path.front() == '[') {
      Step step{.key = {}, .index = 0, .is_index = true};
      const std::size_t end = path.find(']');
      if (end == path.npos || steps.empty()) return {};
      const auto [stop, error] = std::from_chars(path.data() + 1, path.data() + end, step.index);
      if (error != std::errc() || stop != path.data() + end) return {};
      steps.push_back(std::move(step));
      path.remove_prefix(end + 1);
      if (!path.empty() && path.front() != '.' && path.front() != '[') return {};
    } else {
      if (path.front() == '.') {
        if (steps.empty()) return {};
        path.remove_prefix(1);
      }
      const std::string_view key = path.substr(0, path.find_first_of(".["));
      if (key.empty()) return {};
      steps.push_back({.key = std::string(key), .index = 0, .is_index = false});
      path.remove_prefix(key.size());
    }
  }
  if (steps.empty()) return {};
  return steps;
}

void mark_all(Node& node, const Mark& mark) {
  node.mark = mark;
  for (Node& item : node.items) mark_all(item, mark);
  for (MapEntry& entry : node.entries) {
    entry.mark = mark;
    mark_all(entry.value, mark);
  }
}

/// The child of `node` that the step names, made if it is a key; null and a message if there cannot be one.
Node* child(Node& node, const Step& step, const Mark& mark, std::string& message) {
  if (step.is_index) {
    if (!node.is_sequence()) {
      message = "needs a list, but there is " + shown(node);
    } else if (step.index >= node.items.size()) {
      message = "no entry [" + std::to_string(step.index) + "], the list has " + std::to_string(node.items.size());
    } else {
      return &node.items[step.index];
    }
    return nullptr;
  }
  if (node.is_null()) {
    node = Node::map();
    node.mark = mark;
  }
  if (!node.is_map()) {
    message = "has no keys, it is " + shown(node);
    return nullptr;
  }
  if (Node* found = node.find(step.key)) return found;
  node.with(step.key, Node());
  node.entries.back().mark = mark;
  node.entries.back().value.mark = mark;
  return &node.entries.back().value;
}

}  // namespace

std::string override_name(std::string_view override) { return "--set " + std::string(override); }

void apply_override(Node& root, const std::string& override, int source, std::vector<base::Diagnostic>& diagnostics) {
  const base::Place place{.file = override_name(override), .line = 0, .column = 0};
  const std::size_t equals = override.find('=');
  const auto steps = parse_path(base::trimmed(std::string_view(override).substr(0, equals)));
  if (equals == override.npos || !steps) {
    diagnostics.push_back(
        {.place = place, .message = "needs path=value, such as dynamics.step=1 or loads.push.force[2]=3"});
    return;
  }
  const std::string_view text = std::string_view(override).substr(equals + 1);
  std::vector<base::Diagnostic> faults;
  std::optional<Node> value =
      base::trimmed(text).empty() ? std::optional<Node>(Node()) : parse_yaml(text, place.file, source, faults);
  for (base::Diagnostic& fault : faults) {
    fault.place = place;  // lines and columns inside the value help nobody
    diagnostics.push_back(std::move(fault));
  }
  if (!value) return;
  const Mark mark{.source = source, .line = 0, .column = 0, .anchor_line = 0};
  mark_all(*value, mark);

  Node edited = root;  // a path that leads nowhere must leave no trace
  Node* node = &edited;
  std::string path;
  for (const Step& step : *steps) {
    std::string message;
    Node* next = child(*node, step, mark, message);
    if (next == nullptr) {
      diagnostics.push_back({.place = place, .path = path, .message = std::move(message)});
      return;
    }
    path += step.is_index ? "[" + std::to_string(step.index) + "]" : (path.empty() ? "" : ".") + step.key;
    node = next;
  }
  *node = std::move(*value);
  root = std::move(edited);
}

}  // namespace muldi::scene
