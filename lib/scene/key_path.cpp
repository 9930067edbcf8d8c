#include "scene/key_path.hpp"

#include <charconv>

namespace muldi::scene {

std::optional<std::vector<KeyStep>> parse_key_path(std::string_view path) {
  std::vector<KeyStep> steps;
  while (!path.empty()) {
    if (path.front() == '[') {
      KeyStep step{.key = {}, .index = 0, .is_index = true};
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

const Node* node_at(const Node& root, std::string_view path) {
  const auto steps = parse_key_path(path);
  if (!steps) return nullptr;
  const Node* node = &root;
  for (const KeyStep& step : *steps) {
    if (step.is_index) {
      if (!node->is_sequence() || step.index >= node->items.size()) return nullptr;
      node = &node->items[step.index];
    } else {
      node = node->find(step.key);
      if (node == nullptr) return nullptr;
    }
  }
  return node;
}

std::vector<std::string> names_in(const Node& map) {
  std::vector<std::string> names;
  names.reserve(map.entries.size());
  for (const MapEntry& entry : map.entries) names.push_back(entry.key);
  return names;
}

}  // namespace muldi::scene
