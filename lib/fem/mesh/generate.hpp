#pragma once
/// Meshes from what a scene says of them.
#include <string>

#include "fem/mesh/box.hpp"
#include "fem/mesh/cylinder.hpp"
#include "fem/mesh/mesh.hpp"
#include "fem/mesh/mesh_file.hpp"
#include "fem/mesh/stack.hpp"

namespace muldi::fem {

/// Nodes by layers along z, in each x first. The fields must be valid (why_invalid()), here and below.
Mesh make_mesh(const Box& box);
/// Nodes by layers along the axis.
Mesh make_mesh(const Cylinder& cylinder);
Mesh make_mesh(const Stack& stack);
/// Reads the file; a relative path starts in `folder` (empty: the current one). InputError where it is no usable mesh.
Mesh make_mesh(const MeshFile& file, const std::string& folder);

}  // namespace muldi::fem
