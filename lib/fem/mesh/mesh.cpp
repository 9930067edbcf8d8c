#include "fem/mesh/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.hpp"

namespace muldi::fem {
namespace {

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }

template <class Sets>
auto find_named(const Sets& sets, std::string_view name) -> decltype(sets.data()) {
  for (const auto& set : sets) {
    if (set.name == name) return &set;
  }
  return nullptr;
}

std::string labelled(const char* what, int index, const std::vector<long>& labels) {
  std::string text = what + std::to_string(index);
  if (!labels.empty()) text += " (" + std::to_string(labels[static_cast<std::size_t>(index)]) + " in the file)";
  return text;
}

}  // namespace

const FaceSet* Mesh::find_faces(std::string_view name) const { return find_named(face_sets, name); }
const NodeSet* Mesh::find_nodes(std::string_view name) const { return find_named(node_sets, name); }
int Mesh::find_part(std::string_view name) const {
  const auto found = std::find(parts.begin(), parts.end(), name);
  return found == parts.end() ? -1 : static_cast<int>(found - parts.begin());
}

double Bounds::diagonal() const { return norm(minus(high, low)); }

Bounds bounds_of(const Mesh& mesh) {
  if (mesh.nodes.empty()) return {};
  Bounds bounds{.low = mesh.nodes.front(), .high = mesh.nodes.front()};
  for (const Vec3& node : mesh.nodes) {
    for (std::size_t i = 0; i < 3; ++i) {
      bounds.low[i] = std::min(bounds.low[i], node[i]);
      bounds.high[i] = std::max(bounds.high[i], node[i]);
    }
  }
  return bounds;
}

double shortest_edge(const Mesh& mesh) {
  constexpr int edges[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  double shortest = std::numeric_limits<double>::infinity();
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    for (const auto& edge : edges) {
      const Vec3 along = minus(mesh.node_of(cell, edge[1]), mesh.node_of(cell, edge[0]));
      shortest = std::min(shortest, dot(along, along));
    }
  }
  return mesh.cells.empty() ? 0.0 : std::sqrt(shortest);
}

std::array<int, 4> face_nodes(const Mesh& mesh, const CellFace& face) {
  std::array<int, 4> nodes{};
  for (std::size_t i = 0; i < 4; ++i) {
    const int corner = nodes_of_face[static_cast<std::size_t>(face.face)][i];
    nodes[i] = mesh.cells[static_cast<std::size_t>(face.cell)][static_cast<std::size_t>(corner)];
  }
  return nodes;
}

Vec3 face_centre(const Mesh& mesh, const CellFace& face) {
  Vec3 sum{};
  for (const int node : face_nodes(mesh, face)) {
    for (std::size_t i = 0; i < 3; ++i) sum[i] += 0.25 * mesh.nodes[static_cast<std::size_t>(node)][i];
  }
  return sum;
}

Vec3 face_normal(const Mesh& mesh, const CellFace& face) {
  const std::array<int, 4> at = face_nodes(mesh, face);
  const auto node = [&](std::size_t i) { return mesh.nodes[static_cast<std::size_t>(at[i])]; };
  Vec3 normal = cross(minus(node(2), node(0)), minus(node(3), node(1)));
  for (double& component : normal) component *= 0.5;
  return normal;
}

double face_area(const Mesh& mesh, const CellFace& face) { return norm(face_normal(mesh, face)); }

namespace {

/// Derivatives of the eight shape functions at a point of the reference cube.
using Slopes = std::array<Vec3, 8>;

Slopes slopes_at(const Vec3& reference) {
  Slopes slopes{};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const Vec3& c = corners_of_cell[corner];
    const Vec3 factor{1 + c[0] * reference[0], 1 + c[1] * reference[1], 1 + c[2] * reference[2]};
    slopes[corner] = {0.125 * c[0] * factor[1] * factor[2], 0.125 * c[1] * factor[0] * factor[2],
                      0.125 * c[2] * factor[0] * factor[1]};
  }
  return slopes;
}

double determinant(const Mesh& mesh, int cell, const Slopes& slopes) {
  std::array<Vec3, 3> tangents{};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const Vec3& x = mesh.node_of(cell, static_cast<int>(corner));
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t i = 0; i < 3; ++i) tangents[j][i] += slopes[corner][j] * x[i];
    }
  }
  return dot(tangents[0], cross(tangents[1], tangents[2]));
}

}  // namespace

double jacobian(const Mesh& mesh, int cell, const Vec3& reference) {
  return determinant(mesh, cell, slopes_at(reference));
}

double jacobian_at_corner(const Mesh& mesh, int cell, int corner) {
  static const std::array<Slopes, 8> slopes = [] {
    std::array<Slopes, 8> all{};
    for (std::size_t i = 0; i < 8; ++i) all[i] = slopes_at(corners_of_cell[i]);
    return all;
  }();
  return determinant(mesh, cell, slopes[static_cast<std::size_t>(corner)]);
}

Vec3 gauss_point(int i) {
  const double at = 1.0 / std::sqrt(3.0);
  const Vec3& corner = corners_of_cell[static_cast<std::size_t>(i)];
  return {at * corner[0], at * corner[1], at * corner[2]};
}

double jacobian_at_gauss_point(const Mesh& mesh, int cell, int point) {
  static const std::array<Slopes, 8> slopes = [] {
    std::array<Slopes, 8> all{};
    for (int i = 0; i < 8; ++i) all[static_cast<std::size_t>(i)] = slopes_at(gauss_point(i));
    return all;
  }();
  return determinant(mesh, cell, slopes[static_cast<std::size_t>(point)]);
}

double cell_volume(const Mesh& mesh, int cell) {
  double volume = 0.0;
  for (int i = 0; i < 8; ++i) volume += jacobian_at_gauss_point(mesh, cell, i);
  return volume;
}

std::vector<SharedFace> all_faces(const Mesh& mesh) {
  // By their least node first, a bin each: at most a few tens of faces are left to sort in one.
  std::vector<std::size_t> start(mesh.nodes.size() + 1, 0);
  std::vector<SharedFace> unsorted;
  unsorted.reserve(6 * mesh.cells.size());
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    for (int face = 0; face < 6; ++face) {
      SharedFace shared{.key = face_nodes(mesh, {.cell = cell, .face = face}), .face = {.cell = cell, .face = face}};
      std::sort(shared.key.begin(), shared.key.end());
      ++start[static_cast<std::size_t>(shared.key[0]) + 1];
      unsorted.push_back(shared);
    }
  }
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  std::vector<SharedFace> faces(unsorted.size());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for (const SharedFace& shared : unsorted) faces[next[static_cast<std::size_t>(shared.key[0])]++] = shared;
  const auto at = [&](std::size_t i) { return faces.begin() + static_cast<std::ptrdiff_t>(i); };
  for (std::size_t node = 0; node + 1 < start.size(); ++node) {
    std::stable_sort(at(start[node]), at(start[node + 1]),
                     [](const SharedFace& a, const SharedFace& b) { return a.key < b.key; });
  }
  return faces;
}

std::vector<CellFace> boundary_faces(const Mesh& mesh) {
  const std::vector<SharedFace> faces = all_faces(mesh);
  std::vector<CellFace> boundary;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t next = i + 1;
    while (next < faces.size() && faces[next].key == faces[i].key) ++next;
    if (next == i + 1) boundary.push_back(faces[i].face);
    i = next;
  }
  std::sort(boundary.begin(), boundary.end(),
            [](const CellFace& a, const CellFace& b) { return a.cell != b.cell ? a.cell < b.cell : a.face < b.face; });
  return boundary;
}

std::string node_name(const Mesh& mesh, int node) { return labelled("node ", node, mesh.labels_of_nodes); }
std::string cell_name(const Mesh& mesh, int cell) { return labelled("cell ", cell, mesh.labels_of_cells); }

std::string position_text(const Vec3& position) {
  return base::format("({}, {}, {})", base::number_text(position[0], 6), base::number_text(position[1], 6),
                      base::number_text(position[2], 6));
}

}  // namespace muldi::fem
