#pragma once
/// Nodes, boundary faces and cells of a mesh by selector.
///
/// All coordinates are in the mesh's own frame, before position and orientation of the solid. A node lies on a plane or
/// in a box within 1e-3 of the mesh's shortest edge; a point names the nearest node within 5e-2 of it.
#include <string>
#include <vector>

#include "fem/mesh/mesh.hpp"
#include "fem/mesh/selector.hpp"

namespace muldi::fem {

/// What a selector finds; where it finds nothing, why.
struct Selected {
  std::vector<int> nodes = {};       ///< sorted
  std::vector<CellFace> faces = {};  ///< boundary faces, by cell; see MeshSelection::faces
  std::vector<int> cells = {};
  std::string error = {};  ///< empty if something was found
};

/// Selections of one mesh, which must outlive it.
class MeshSelection {
 public:
  explicit MeshSelection(const Mesh& mesh);

  /// Nodes of the selection; for a face also the faces.
  Selected nodes(const Selector& selector) const;
  /// Boundary faces: those of the name, of the part, or those all of whose nodes are selected; with their nodes.
  Selected faces(const Selector& selector) const;
  /// Cells: of a part, all, or those all of whose nodes are selected; with their nodes.
  Selected cells(const Selector& selector) const;

 private:
  Selected by_name(const SelectFace& selector) const;
  Selected by_plane(const PlaneAt& plane) const;
  Selected by_set(const SelectSet& selector) const;
  Selected by_point(const Vec3& point) const;
  Selected by_part(const SelectPart& selector) const;
  template <class Keep>
  Selected where(Keep keep, const std::string& what) const;
  std::string empty_text(const std::string& what) const;

  const Mesh& mesh_;
  std::vector<CellFace> boundary_;
  Bounds bounds_;
  double edge_ = 0.0;
};

/// Names of all faces, then of the node sets that are no faces.
std::vector<std::string> face_and_set_names(const Mesh& mesh);

}  // namespace muldi::fem
