#include "fem/mesh/selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/diagnostic.hpp"
#include "base/text.hpp"

namespace muldi::fem {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

void sort_unique(std::vector<int>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

bool inside(const std::optional<double>& low, const std::optional<double>& high, double value, double tolerance) {
  return (!low || value >= *low - tolerance) && (!high || value <= *high + tolerance);
}

template <class Set>
std::vector<std::string> names_of(const std::vector<Set>& sets) {
  std::vector<std::string> names;
  names.reserve(sets.size());
  for (const Set& set : sets) names.push_back(set.name);
  return names;
}

}  // namespace

std::vector<std::string> face_and_set_names(const Mesh& mesh) {
  std::vector<std::string> names = names_of(mesh.face_sets);
  for (const NodeSet& set : mesh.node_sets) {
    if (mesh.find_faces(set.name) == nullptr) names.push_back(set.name);
  }
  return names;
}

MeshSelection::MeshSelection(const Mesh& mesh)
    : mesh_(mesh), boundary_(boundary_faces(mesh)), bounds_(bounds_of(mesh)), edge_(shortest_edge(mesh)) {}

std::string MeshSelection::empty_text(const std::string& what) const {
  std::string text = what + "; the mesh spans";
  for (std::size_t i = 0; i < 3; ++i) {
    text += base::format("{} {} from {} to {}", i == 0 ? "" : ",", "xyz"[i], base::number_text(bounds_.low[i], 6),
                         base::number_text(bounds_.high[i], 6));
  }
  return text + " in its own frame";
}

template <class Keep>
Selected MeshSelection::where(Keep keep, const std::string& what) const {
  Selected selected;
  for (int node = 0; node < mesh_.n_nodes(); ++node) {
    if (keep(mesh_.nodes[at(node)])) selected.nodes.push_back(node);
  }
  if (selected.nodes.empty()) selected.error = empty_text(what);
  return selected;
}

Selected MeshSelection::by_name(const SelectFace& selector) const {
  Selected selected;
  const Interval* ranges[] = {&selector.x, &selector.y, &selector.z};
  const double tolerance = 1e-3 * edge_;
  const auto in_range = [&](const Vec3& position) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!inside(ranges[i]->low, ranges[i]->high, position[i], tolerance)) return false;
    }
    return true;
  };
  if (const FaceSet* set = mesh_.find_faces(selector.face)) {
    for (const CellFace& face : set->faces) {
      if (!in_range(face_centre(mesh_, face))) continue;
      selected.faces.push_back(face);
      for (const int node : face_nodes(mesh_, face)) selected.nodes.push_back(node);
    }
    sort_unique(selected.nodes);
    if (selected.faces.empty()) {
      selected.error = empty_text("no face of " + base::in_quotes(selector.face) + " has its centre in these ranges");
    }
    return selected;
  }
  if (const NodeSet* set = mesh_.find_nodes(selector.face)) {
    for (const int node : set->nodes) {
      if (in_range(mesh_.nodes[at(node)])) selected.nodes.push_back(node);
    }
    if (selected.nodes.empty()) {
      selected.error = empty_text("no node of " + base::in_quotes(selector.face) + " lies in these ranges");
    }
    return selected;
  }
  selected.error = "the mesh has no face or set " + base::in_quotes(selector.face) +
                   base::did_you_mean(selector.face, face_and_set_names(mesh_));
  return selected;
}

Selected MeshSelection::by_plane(const PlaneAt& plane) const {
  const std::optional<double> wanted[] = {plane.x, plane.y, plane.z};
  const double tolerance = 1e-3 * edge_;
  std::vector<std::string> named;
  for (std::size_t i = 0; i < 3; ++i) {
    if (wanted[i]) named.push_back(std::string(1, "xyz"[i]) + " = " + base::number_text(*wanted[i], 6));
  }
  std::string what = "no node has " + base::joined(named);
  if (named.size() == 1) {
    const std::size_t axis = wanted[0] ? 0 : wanted[1] ? 1 : 2;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3& node : mesh_.nodes) {
      if (std::abs(node[axis] - *wanted[axis]) < std::abs(nearest - *wanted[axis])) nearest = node[axis];
    }
    what += ", the nearest are at " + base::number_text(nearest, 9);
  }
  return where(
      [&](const Vec3& node) {
        for (std::size_t i = 0; i < 3; ++i) {
          if (!inside(wanted[i], wanted[i], node[i], tolerance)) return false;
        }
        return true;
      },
      what);
}

Selected MeshSelection::by_set(const SelectSet& selector) const {
  Selected selected;
  if (const NodeSet* set = mesh_.find_nodes(selector.set)) {
    selected.nodes = set->nodes;
    if (selected.nodes.empty()) selected.error = "set " + base::in_quotes(selector.set) + " has no nodes";
    return selected;
  }
  const std::vector<std::string> names = names_of(mesh_.node_sets);
  selected.error =
      names.empty() ? "the mesh has no sets of nodes, got " + base::in_quotes(selector.set)
                    : "the mesh has no set " + base::in_quotes(selector.set) + base::did_you_mean(selector.set, names);
  return selected;
}

Selected MeshSelection::by_point(const Vec3& point) const {
  Selected selected;
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int node = 0; node < mesh_.n_nodes(); ++node) {
    const Vec3& x = mesh_.nodes[at(node)];
    const double gap = std::hypot(x[0] - point[0], x[1] - point[1], x[2] - point[2]);
    if (gap >= least) continue;
    least = gap;
    nearest = node;
  }
  if (nearest < 0) {
    selected.error = "the mesh has no nodes";
  } else if (least > 5e-2 * edge_) {
    selected.error = "no node is at " + position_text(point) + "; the nearest is " + node_name(mesh_, nearest) +
                     " at " + position_text(mesh_.nodes[at(nearest)]);
  } else {
    selected.nodes = {nearest};
  }
  return selected;
}

Selected MeshSelection::by_part(const SelectPart& selector) const {
  Selected selected;
  const int part = mesh_.find_part(selector.part);
  if (part < 0) {
    selected.error =
        "the mesh has no part " + base::in_quotes(selector.part) + base::did_you_mean(selector.part, mesh_.parts);
    return selected;
  }
  for (int cell = 0; cell < mesh_.n_cells(); ++cell) {
    if (mesh_.part_of_cell[at(cell)] != part) continue;
    selected.cells.push_back(cell);
    selected.nodes.insert(selected.nodes.end(), mesh_.cells[at(cell)].begin(), mesh_.cells[at(cell)].end());
  }
  sort_unique(selected.nodes);
  for (const CellFace& face : boundary_) {
    if (mesh_.part_of_cell[at(face.cell)] == part) selected.faces.push_back(face);
  }
  if (selected.cells.empty()) selected.error = "part " + base::in_quotes(selector.part) + " has no cells";
  return selected;
}

Selected MeshSelection::nodes(const Selector& selector) const {
  if (const auto* face = std::get_if<SelectFace>(&selector)) return by_name(*face);
  if (const auto* plane = std::get_if<SelectPlane>(&selector)) return by_plane(plane->plane);
  if (const auto* set = std::get_if<SelectSet>(&selector)) return by_set(*set);
  if (const auto* point = std::get_if<SelectPoint>(&selector)) return by_point(point->point);
  if (const auto* part = std::get_if<SelectPart>(&selector)) return by_part(*part);
  if (const auto* box = std::get_if<SelectBox>(&selector)) {
    const double tolerance = 1e-3 * edge_;
    return where(
        [&](const Vec3& node) {
          for (std::size_t i = 0; i < 3; ++i) {
            if (!inside(box->box[0][i], box->box[1][i], node[i], tolerance)) return false;
          }
          return true;
        },
        "no node lies in the box");
  }
  Selected selected = where([](const Vec3&) { return true; }, "no node");
  selected.faces = boundary_;
  for (int cell = 0; cell < mesh_.n_cells(); ++cell) selected.cells.push_back(cell);
  return selected;
}

Selected MeshSelection::faces(const Selector& selector) const {
  Selected selected = nodes(selector);
  if (!selected.error.empty() || !selected.faces.empty()) return selected;
  std::vector<char> chosen(mesh_.nodes.size(), 0);
  for (const int node : selected.nodes) chosen[at(node)] = 1;
  selected.nodes.clear();
  for (const CellFace& face : boundary_) {
    const std::array<int, 4> of_face = face_nodes(mesh_, face);
    if (!std::all_of(of_face.begin(), of_face.end(), [&](int node) { return chosen[at(node)] != 0; })) continue;
    selected.faces.push_back(face);
    selected.nodes.insert(selected.nodes.end(), of_face.begin(), of_face.end());
  }
  sort_unique(selected.nodes);
  if (selected.faces.empty()) selected.error = "selects nodes, but no whole face on the boundary";
  return selected;
}

Selected MeshSelection::cells(const Selector& selector) const {
  Selected selected = nodes(selector);
  if (!selected.error.empty() || !selected.cells.empty()) return selected;
  std::vector<char> chosen(mesh_.nodes.size(), 0);
  for (const int node : selected.nodes) chosen[at(node)] = 1;
  selected.nodes.clear();
  selected.faces.clear();
  for (int cell = 0; cell < mesh_.n_cells(); ++cell) {
    const auto& of_cell = mesh_.cells[at(cell)];
    if (!std::all_of(of_cell.begin(), of_cell.end(), [&](int node) { return chosen[at(node)] != 0; })) continue;
    selected.cells.push_back(cell);
    selected.nodes.insert(selected.nodes.end(), of_cell.begin(), of_cell.end());
  }
  sort_unique(selected.nodes);
  if (selected.cells.empty()) selected.error = "selects nodes, but no whole cell";
  return selected;
}

}  // namespace muldi::fem
