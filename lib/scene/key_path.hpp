#pragma once
/// Paths of scene entries: `path.to[2].key`.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/node.hpp"

namespace muldi::scene {

/// `.key` or `[index]`.
struct KeyStep {
  std::string key;
  std::size_t index = 0;
  bool is_index = false;
};

/// The steps of `a.b[2].c`; nothing if it is no path.
std::optional<std::vector<KeyStep>> parse_key_path(std::string_view path);

/// The node at a path; null if there is none.
const Node* node_at(const Node& root, std::string_view path);

/// The keys of a map.
std::vector<std::string> names_in(const Node& map);

}  // namespace muldi::scene
