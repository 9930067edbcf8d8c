#pragma once
/// Meshes of Gmsh (.msh): formats 2.2 and 4.1, text and binary.
///
/// Hexahedra of eight nodes are the cells; quadrangles on their faces, lines and points only carry the names of their
/// physical groups. Any other element is refused. A physical group of volumes becomes a part (a second group of the
/// same volume a set of nodes), one of surfaces a set of boundary faces and a set of nodes (inside the mesh: of nodes
/// only), one of curves or points a set of nodes. Groups without a name are called volume_1, surface_2, curve_3,
/// point_4. Nodes and cells get an order of their own (node_order.hpp); the numbers in the file are kept as labels.
/// Format: Gmsh reference manual, `MSH file format`.
#include <string>
#include <string_view>

#include "fem/mesh/mesh.hpp"

namespace muldi::fem {

/// Reads a file. InputError, located in the file, where it is none, or no mesh of hexahedra.
Mesh read_gmsh(const std::string& path);

/// The same from the content of a file; `name` stands for it in messages.
Mesh read_gmsh_text(std::string_view content, const std::string& name);

}  // namespace muldi::fem
