#pragma once
/// The JSON Schema of the scene format as a tree.
#include "scene/node.hpp"

namespace muldi::scene {

/// The schema; beside the keywords of draft-07 it has `x-unit`, the unit of bare numbers in the default units.
Node schema_tree();

}  // namespace muldi::scene
