#pragma once
/// The meshes and selectors that scenes may name; the reader, the schema and the documentation follow these lists.
#include "base/describe.hpp"
#include "fem/mesh/box.hpp"
#include "fem/mesh/cylinder.hpp"
#include "fem/mesh/mesh_file.hpp"
#include "fem/mesh/selector.hpp"
#include "fem/mesh/stack.hpp"

namespace muldi::fem {

using MeshTypes = base::TypeList<Box, Cylinder, Stack, MeshFile>;

/// One mesh with what the scene says of it.
using MeshType = base::VariantOf<MeshTypes>;

}  // namespace muldi::fem
