#pragma once
/// One key of the scene format in words, from the descriptions that the reader and the schema follow.
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace muldi::scene {

/// What is known of a key.
struct KeyHelp {
  std::string path = {};      ///< e.g. `joints.<name>.type`
  std::string doc = {};       ///< meaning
  std::string kind = {};      ///< e.g. `number`
  std::string unit = {};      ///< of bare numbers in the default units; empty if none
  std::string range = {};     ///< e.g. `> 0`; empty if any
  std::string standard = {};  ///< default that the format states; empty if none
  std::string need = {};      ///< `yes`, `no`, or with which word of a neighbour it is needed
  std::vector<std::pair<std::string, std::string>> words = {};  ///< admissible words with their meaning
  std::vector<std::pair<std::string, std::string>> keys = {};   ///< keys below with their meaning
};

/// The key at a path: keys joined by dots, where any name, `*` or `<name>` stands for the name of an entry and `[2]` or
/// `[]` for an item of a list (which may be left out); the empty path is the whole scene.
/// InputError where there is no such key, with the nearest one.
KeyHelp look_up(const std::string& path);

/// The same, nothing where there is no such key.
std::optional<KeyHelp> find_key(const std::string& path);

/// What `explain` prints; ends with a newline. InputError as look_up().
std::string explain(const std::string& path);

}  // namespace muldi::scene
