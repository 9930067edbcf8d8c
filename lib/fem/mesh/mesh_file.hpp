#pragma once
/// A mesh from a file of Gmsh.
#include <string>
#include <string_view>

#include "base/describe.hpp"

namespace muldi::fem {

/// Physical groups of volumes are parts, of surfaces faces and node sets, of curves and points node sets.
struct MeshFile {
  static constexpr std::string_view name = "file";
  static constexpr std::string_view doc =
      "hexahedra of a Gmsh file (.msh 2.2 or 4.1, text or binary); physical groups give the names of parts, faces and "
      "sets of nodes";
  static constexpr bool named_by_field = true;  ///< {file: part.msh, scale: 1000}

  std::string path = {};  ///< as written
  double scale = 1.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "file", .doc = "the file, in the scene's folder or below"}, self.path);
    visit(Field{.key = "scale",
                .doc = "multiplies the coordinates of the file, e.g. 1000 from m to mm",
                .range = positive,
                .need = Need::optional},
          self.scale);
  }
  friend bool operator==(const MeshFile&, const MeshFile&) = default;

  std::string why_invalid() const { return {}; }
};

}  // namespace muldi::fem
