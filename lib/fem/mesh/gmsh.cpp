#include "fem/mesh/gmsh.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unordered_map>

#include "base/error.hpp"
#include "base/text.hpp"
#include "fem/mesh/generators.hpp"
#include "fem/mesh/gmsh_content.hpp"
#include "fem/mesh/node_order.hpp"

namespace muldi::fem {
namespace {

/// `quadrangles (12)`.
std::string counted(int type, long n) {
  return std::string(find_element_type(type)->plural) + " (" + std::to_string(n) + ")";
}

/// Makes the mesh of one file.
class MeshMaker {
 public:
  MeshMaker(const GmshContent& content, std::string name) : content_(content), name_(std::move(name)) {}

  Mesh run() {
    refuse_other_elements();
    number_nodes();
    add_cells();
    drop_loose_nodes();
    faces_ = all_faces(mesh_);
    for (const GmshElement& element : content_.elements) add_to_groups(element);
    for (NodeSet& set : mesh_.node_sets) {
      std::sort(set.nodes.begin(), set.nodes.end());
      set.nodes.erase(std::unique(set.nodes.begin(), set.nodes.end()), set.nodes.end());
    }
    order_by_neighbours(mesh_);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(std::string message) const {
    throw base::InputError({base::Diagnostic{.place = {.file = name_}, .message = std::move(message)}});
  }

  void refuse_other_elements() const {
    std::vector<std::string> others;
    for (const auto& [type, n] : content_.refused) {
      others.push_back(counted(type, n));
    }
    if (!others.empty()) {
      fail("has " + base::joined(others) +
           ": only hexahedra of 8 nodes are cells, with quadrangles of 4 nodes on them");
    }
    std::map<int, long> counts;
    for (const GmshElement& element : content_.elements) ++counts[element.type];
    if (counts[gmsh_type::hexahedron] > 0) return;
    for (const auto& [type, n] : counts) {
      if (n > 0) others.push_back(counted(type, n));
    }
    fail("has no hexahedra" + (others.empty() ? "" : ", only " + base::joined(others)) +
         ": with groups, Gmsh writes only what is in one, so make one of the volume");
  }

  void number_nodes() {
    index_.reserve(content_.nodes.size());
    for (std::size_t i = 0; i < content_.node_tags.size(); ++i) {
      if (!index_.emplace(content_.node_tags[i], static_cast<int>(i)).second) {
        fail("node " + std::to_string(content_.node_tags[i]) + " stands twice in $Nodes");
      }
    }
  }

  int node(const GmshElement& element, std::size_t i) const {
    const auto found = index_.find(element.nodes[i]);
    if (found == index_.end()) {
      fail("element " + std::to_string(element.tag) + " names node " + std::to_string(element.nodes[i]) +
           ", which $Nodes does not have");
    }
    return found->second;
  }

  std::string group_name(int dimension, int number) const {
    const auto found = content_.group_names.find({dimension, number});
    if (found != content_.group_names.end() && !found->second.empty()) return found->second;
    constexpr const char* kinds[] = {"point_", "curve_", "surface_", "volume_"};
    return kinds[dimension] + std::to_string(number);
  }

  int part(const GmshElement& element) {
    const std::string name = element.groups.empty() ? std::string(default_part) : group_name(3, element.groups.front());
    const int known = mesh_.find_part(name);
    if (known >= 0) return known;
    mesh_.parts.push_back(name);
    return static_cast<int>(mesh_.parts.size()) - 1;
  }

  void add_cells() {
    for (const GmshElement& element : content_.elements) {
      if (element.type != gmsh_type::hexahedron) continue;
      std::array<int, 8>& cell = mesh_.cells.emplace_back();
      for (std::size_t i = 0; i < 8; ++i) cell[i] = node(element, i);
      mesh_.part_of_cell.push_back(part(element));
      mesh_.labels_of_cells.push_back(element.tag);
    }
  }

  /// Centres of circles and the like: points of the drawing that belong to no cell.
  void drop_loose_nodes() {
    new_number_.assign(content_.nodes.size(), -1);
    for (const auto& cell : mesh_.cells) {
      for (const int used : cell) new_number_[static_cast<std::size_t>(used)] = 0;
    }
    int n = 0;
    for (std::size_t i = 0; i < new_number_.size(); ++i) {
      if (new_number_[i] < 0) continue;
      new_number_[i] = n++;
      mesh_.nodes.push_back(content_.nodes[i]);
      mesh_.labels_of_nodes.push_back(content_.node_tags[i]);
    }
    for (auto& cell : mesh_.cells) {
      for (int& used : cell) used = new_number_[static_cast<std::size_t>(used)];
    }
    const std::size_t n_loose = content_.nodes.size() - mesh_.nodes.size();
    if (n_loose > 0) {
      mesh_.notes.push_back(name_ + ": nodes of no hexahedron are left out (" + std::to_string(n_loose) + ")");
    }
  }

  FaceSet& faces_of(const std::string& name) {
    for (FaceSet& set : mesh_.face_sets) {
      if (set.name == name) return set;
    }
    return mesh_.face_sets.emplace_back(FaceSet{.name = name, .faces = {}});
  }
  NodeSet& nodes_of(const std::string& name) {
    for (NodeSet& set : mesh_.node_sets) {
      if (set.name == name) return set;
    }
    return mesh_.node_sets.emplace_back(NodeSet{.name = name, .nodes = {}});
  }

  void add_to_groups(const GmshElement& element) {
    const int dimension = find_element_type(element.type)->dimension;
    std::vector<int> nodes;
    for (std::size_t i = 0; i < element.nodes.size(); ++i) {
      const int number = new_number_[static_cast<std::size_t>(node(element, i))];
      if (number >= 0) nodes.push_back(number);
    }
    // The first group of a hexahedron is its part.
    for (std::size_t i = dimension == 3 ? 1 : 0; i < element.groups.size(); ++i) {
      const std::string name = group_name(dimension, element.groups[i]);
      if (!nodes.empty()) {
        NodeSet& set = nodes_of(name);
        set.nodes.insert(set.nodes.end(), nodes.begin(), nodes.end());
      }
      if (dimension == 2) add_face(element, name, nodes);
    }
  }

  void add_face(const GmshElement& element, const std::string& group, const std::vector<int>& nodes) {
    std::array<int, 4> key{-1, -1, -1, -1};
    std::copy(nodes.begin(), nodes.end(), key.begin());
    std::sort(key.begin(), key.end());
    const auto before = [](const SharedFace& face, const std::array<int, 4>& k) { return face.key < k; };
    const auto first = std::lower_bound(faces_.begin(), faces_.end(), key, before);
    if (first == faces_.end() || first->key != key) {
      fail("quadrangle " + std::to_string(element.tag) + " of group " + base::in_quotes(group) +
           " is no face of a hexahedron");
    }
    const bool inside = first + 1 != faces_.end() && (first + 1)->key == key;
    if (!inside) faces_of(group).faces.push_back(first->face);
  }

  const GmshContent& content_;
  std::string name_;
  Mesh mesh_;
  std::unordered_map<long, int> index_;
  std::vector<int> new_number_;  // -1: left out
  std::vector<SharedFace> faces_;
};

}  // namespace

Mesh read_gmsh_text(std::string_view content, const std::string& name) {
  const GmshContent read = read_gmsh_content(content, name);
  return MeshMaker(read, name).run();
}

Mesh read_gmsh(const std::string& path) {
  // A device or a pipe may never end.
  std::error_code code;
  const auto kind = std::filesystem::status(path, code).type();
  if (kind == std::filesystem::file_type::character || kind == std::filesystem::file_type::fifo) {
    throw base::InputError(
        {base::Diagnostic{.place = {.file = path}, .message = "cannot read: it is a device or a pipe"}});
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);  // a folder opens, but cannot be read
  std::ostringstream content;
  if (file) content << file.rdbuf();
  if (!file || (content.view().empty() && errno != 0)) {
    throw base::InputError(
        {base::Diagnostic{.place = {.file = path}, .message = std::string("cannot read: ") + std::strerror(errno)}});
  }
  return read_gmsh_text(content.str(), path);
}

}  // namespace muldi::fem
