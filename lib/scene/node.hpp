#pragma once
/// The tree of a YAML document with positions: anchors expanded, merge keys resolved, keys unique.
#include <string>
#include <string_view>
#include <vector>

namespace muldi::scene {

/// Where a node stands.
struct Mark {
  int source = 0;  ///< 0: the scene file; k: the k-th override
  int line = 0;    ///< these two count from 1; 0: none
  int column = 0;
  int anchor_line = 0;  ///< line of the anchor if the node came through an alias (line and column are the alias's)
};

struct MapEntry;

struct Node {
  enum class Kind { null, scalar, sequence, map };

  Kind kind = Kind::null;
  bool quoted = false;  ///< a scalar in quotes: text, whatever it looks like
  Mark mark = {};
  std::string text;               ///< of a scalar
  std::vector<Node> items;        ///< of a sequence
  std::vector<MapEntry> entries;  ///< of a map

  bool is_null() const { return kind == Kind::null; }
  bool is_scalar() const { return kind == Kind::scalar; }
  bool is_sequence() const { return kind == Kind::sequence; }
  bool is_map() const { return kind == Kind::map; }

  /// The value of `key` in a map, or null.
  const Node* find(std::string_view key) const;
  Node* find(std::string_view key);

  static Node scalar(std::string text, bool quoted = false);
  static Node sequence();
  static Node sequence(std::vector<Node> items);
  static Node map();
  /// Appends an entry to a map and returns this.
  Node& with(std::string key, Node value);
};

struct MapEntry {
  std::string key = {};
  Mark mark = {};
  Node value = {};
};

/// What a node is, for messages: `a map`, `a list`, `nothing`, or the quoted text.
std::string shown(const Node& node);

/// The tree as YAML: maps in blocks, short ones and lists in one line.
std::string to_yaml(const Node& node);

/// The tree as JSON: quoted scalars are strings, others stand as they are.
std::string to_json(const Node& node);

}  // namespace muldi::scene
