#pragma once
/// What the schema says of one field, in words.
#include <string>

#include "scene/node.hpp"

namespace muldi::scene {

/// The kind of value that the schema of a field admits, e.g. `number`, `list of 3 x number`, `function of time`.
std::string kind_of(const Node& schema);

/// The range that it states, e.g. `> 0 and <= 0.5`; empty if any number will do.
std::string range_of(const Node& schema);

/// Whether the schema of a map asks for this key whatever else stands in the map.
bool is_required(const Node& object, const std::string& key);

}  // namespace muldi::scene
