#include "scene/overrides.hpp"

#include <array>
#include <optional>
#include <utility>

#include "base/text.hpp"
#include "scene/key_path.hpp"
#include "scene/yaml.hpp"

namespace muldi::scene {
namespace {

/// Sections of named entries, with what one of them is called.
constexpr std::array<std::array<std::string_view, 2>, 8> sections{{{"materials", "material"},
                                                                   {"bodies", "body"},
                                                                   {"joints", "joint"},
                                                                   {"controls", "control"},
                                                                   {"muscles", "muscle"},
                                                                   {"solids", "solid"},
                                                                   {"springs", "spring"},
                                                                   {"loads", "load"}}};

void mark_all(Node& node, const Mark& mark) {
  node.mark = mark;
  for (Node& item : node.items) mark_all(item, mark);
  for (MapEntry& entry : node.entries) {
    entry.mark = mark;
    mark_all(entry.value, mark);
  }
}

/// The child of `node` that the step names, made if it is a key; null and a message if there cannot be one.
Node* child(Node& node, const KeyStep& step, const Mark& mark, std::string& message) {
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

/// What is wrong with a path that leads into an entry which its section lacks; empty where nothing is.
std::string missing_entry(const Node& root, const std::vector<KeyStep>& steps) {
  if (steps.size() < 3 || steps[1].is_index) return {};
  const std::string_view noun = noun_of(steps[0].key);
  const Node* section = noun.empty() ? nullptr : root.find(steps[0].key);
  if (section == nullptr || !section->is_map() || section->entries.empty()) return {};
  if (section->find(steps[1].key) != nullptr) return {};
  const std::vector<std::string> names = names_in(*section);
  return base::format("the scene has no {} '{}'{}; a new one is set as a whole: {}.{}={{...}}", noun, steps[1].key,
                      base::did_you_mean(steps[1].key, names), steps[0].key, steps[1].key);
}

}  // namespace

std::string_view noun_of(std::string_view section) {
  for (const auto& [name, noun] : sections) {
    if (name == section) return noun;
  }
  return {};
}

std::string override_name(std::string_view override) { return "--set " + std::string(override); }

void apply_override(Node& root, const std::string& override, int source, std::vector<base::Diagnostic>& diagnostics) {
  const base::Place place{.file = override_name(override), .line = 0, .column = 0};
  const std::size_t equals = override.find('=');
  const auto steps = parse_key_path(base::trimmed(std::string_view(override).substr(0, equals)));
  if (equals == override.npos || !steps) {
    diagnostics.push_back(
        {.place = place, .message = "needs path=value, such as dynamics.step=1 or loads.push.force[2]=3"});
    return;
  }
  if (std::string message = missing_entry(root, *steps); !message.empty()) {
    const std::string path = base::format("{}.{}", (*steps)[0].key, (*steps)[1].key);
    diagnostics.push_back({.place = place, .path = path, .message = std::move(message)});
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
  for (const KeyStep& step : *steps) {
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
