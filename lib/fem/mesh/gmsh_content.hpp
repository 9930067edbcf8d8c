#pragma once
/// What stands in a Gmsh file, before it becomes a mesh.
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/describe.hpp"

namespace muldi::fem {

/// A type of element of Gmsh that is known by name.
struct GmshElementType {
  int number = 0;
  int dimension = 0;
  int n_nodes = 0;
  std::string_view plural = {};
};

/// The type of this number, or null.
const GmshElementType* find_element_type(long number);

namespace gmsh_type {
inline constexpr int line = 1;
inline constexpr int quadrangle = 3;
inline constexpr int hexahedron = 5;
inline constexpr int point = 15;
}  // namespace gmsh_type

struct GmshElement {
  long tag = 0;
  int type = 0;
  std::vector<int> groups = {};  ///< physical groups of the element's dimension
  std::vector<long> nodes = {};  ///< tags
};

struct GmshContent {
  std::vector<long> node_tags = {};
  std::vector<base::Vec3> nodes = {};
  std::vector<GmshElement> elements = {};                    ///< lines, quadrangles, hexahedra and points
  std::map<int, long> refused = {};                          ///< number of elements of each other type
  std::map<std::pair<int, int>, std::string> group_names{};  ///< by dimension and number
};

/// Reads the sections of a file. InputError, located, where they are broken.
GmshContent read_gmsh_content(std::string_view content, const std::string& name);

}  // namespace muldi::fem
