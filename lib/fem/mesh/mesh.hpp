#pragma once
/// Hexahedral meshes as plain data: what the generators and the file reader make, and what the model is built from.
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/describe.hpp"

namespace muldi::fem {

using base::Vec3;

/// A local face of a cell: 0 x-, 1 x+, 2 y-, 3 y+, 4 z-, 5 z+ of the reference cube.
struct CellFace {
  int cell = 0;
  int face = 0;

  friend bool operator==(const CellFace&, const CellFace&) = default;
};

/// Faces on the boundary under a name.
struct FaceSet {
  std::string name = {};
  std::vector<CellFace> faces = {};
};

/// Nodes under a name, sorted.
struct NodeSet {
  std::string name = {};
  std::vector<int> nodes = {};
};

/// One layer of a part along the axis of an extruded mesh: the node layers from `first` to `last`, both included.
struct Slab {
  int part = 0;
  int first = 0;
  int last = 0;
};

/// Node numbers of the local faces in the order of CellFace, counterclockwise seen from outside.
inline constexpr std::array<std::array<int, 4>, 6> nodes_of_face{
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};

/// Corners of the reference cube [-1, 1]^3 in the order of VTK (and Gmsh): 0-3 below counterclockwise, 4-7 above.
inline constexpr std::array<Vec3, 8> corners_of_cell{
    {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};

struct Mesh {
  std::vector<Vec3> nodes = {};                ///< reference positions in the mesh's own frame, unit of length
  std::vector<std::array<int, 8>> cells = {};  ///< node numbers, in the order of corners_of_cell
  std::vector<int> part_of_cell = {};
  std::vector<std::string> parts = {};
  std::vector<FaceSet> face_sets = {};
  std::vector<NodeSet> node_sets = {};
  std::vector<int> layer_of_node = {};     ///< of extruded meshes: index of the node layer along the axis; else empty
  std::vector<Slab> slabs = {};            ///< of extruded meshes: the layers of parts along the axis
  std::vector<long> labels_of_nodes = {};  ///< of files: the numbers there; empty: those of the mesh
  std::vector<long> labels_of_cells = {};
  std::vector<std::string> notes = {};  ///< what the reader left out, for the user

  int n_nodes() const { return static_cast<int>(nodes.size()); }
  int n_cells() const { return static_cast<int>(cells.size()); }
  int n_layers() const { return slabs.empty() ? 0 : slabs.back().last + 1; }
  const FaceSet* find_faces(std::string_view name) const;
  const NodeSet* find_nodes(std::string_view name) const;
  /// Index of the part, or -1.
  int find_part(std::string_view name) const;
  const Vec3& node_of(int cell, int corner) const {
    return nodes[static_cast<std::size_t>(cells[static_cast<std::size_t>(cell)][static_cast<std::size_t>(corner)])];
  }
};

/// Corners of an axis-parallel box.
struct Bounds {
  Vec3 low = {};
  Vec3 high = {};

  double diagonal() const;
};

/// The box around all nodes.
Bounds bounds_of(const Mesh& mesh);
/// Length of the shortest edge of a cell; 0 without cells.
double shortest_edge(const Mesh& mesh);
/// Node numbers of a face, counterclockwise seen from outside.
std::array<int, 4> face_nodes(const Mesh& mesh, const CellFace& face);
/// Mean of the four nodes of a face.
Vec3 face_centre(const Mesh& mesh, const CellFace& face);
/// Area of a face: half the cross product of its diagonals, exact for plane faces.
double face_area(const Mesh& mesh, const CellFace& face);
/// Area vector of a face, outward.
Vec3 face_normal(const Mesh& mesh, const CellFace& face);

/// d(x, y, z)/d(reference coordinates) of a cell, as a determinant.
double jacobian(const Mesh& mesh, int cell, const Vec3& reference);
/// The same at a corner and at a Gauss point of the cell.
double jacobian_at_corner(const Mesh& mesh, int cell, int corner);
double jacobian_at_gauss_point(const Mesh& mesh, int cell, int point);
/// Volume of a cell by 2x2x2 Gauss points, exact for trilinear cells.
double cell_volume(const Mesh& mesh, int cell);
/// Reference coordinates of the 8 Gauss points, in the order of the corners.
Vec3 gauss_point(int i);

/// All faces of all cells, those with the same nodes side by side.
struct SharedFace {
  std::array<int, 4> key = {};  ///< sorted node numbers
  CellFace face = {};
};
std::vector<SharedFace> all_faces(const Mesh& mesh);
/// The faces that belong to one cell only, by cell and local face.
std::vector<CellFace> boundary_faces(const Mesh& mesh);

/// `node 12` or `node 12 (345 in the file)`; counted from 0.
std::string node_name(const Mesh& mesh, int node);
std::string cell_name(const Mesh& mesh, int cell);
/// `(1, 2.5, 0)`.
std::string position_text(const Vec3& position);

}  // namespace muldi::fem
