#include "fem/mesh/generate.hpp"

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "fem/mesh/gmsh.hpp"
#include "fem/mesh/planar_section.hpp"

namespace muldi::fem {
namespace {

/// Equal layers of one part.
struct Sheet {
  int part = 0;
  double thickness = 0.0;
  int cells = 1;
};

/// Coordinates along the axis of the section's first, second and third axis.
Vec3 turned(Axis axis, const std::array<double, 2>& in_section, double along) {
  const auto third = static_cast<std::size_t>(axis);
  Vec3 position{};
  position[(third + 1) % 3] = in_section[0];
  position[(third + 2) % 3] = in_section[1];
  position[third] = along;
  return position;
}

/// Node layers from the sheets, from 0 along the axis; both ends of a sheet are exact sums of thicknesses.
std::vector<double> layer_positions(const std::vector<Sheet>& sheets) {
  std::vector<double> positions{0.0};
  double start = 0.0;
  for (const Sheet& sheet : sheets) {
    for (int i = 1; i < sheet.cells; ++i) positions.push_back(start + sheet.thickness * i / sheet.cells);
    start += sheet.thickness;
    positions.push_back(start);
  }
  return positions;
}

void add_cells(const PlanarSection& section, const std::vector<Sheet>& sheets, Mesh& mesh) {
  const int n = static_cast<int>(section.nodes.size());
  int layer = 0;
  for (const Sheet& sheet : sheets) {
    if (!mesh.slabs.empty() && mesh.slabs.back().part == sheet.part) {
      mesh.slabs.back().last += sheet.cells;
    } else {
      mesh.slabs.push_back({.part = sheet.part, .first = layer, .last = layer + sheet.cells});
    }
    for (int i = 0; i < sheet.cells; ++i, ++layer) {
      const int below = layer * n;
      const int above = below + n;
      for (const auto& [a, b, c, d] : section.quads) {
        mesh.cells.push_back({below + a, below + b, below + c, below + d, above + a, above + b, above + c, above + d});
        mesh.part_of_cell.push_back(sheet.part);
      }
    }
  }
}

/// The local face of a hexahedron over the edge of its quadrangle: y-, x+, y+, x-.
constexpr std::array<int, 4> face_over_edge{2, 1, 3, 0};

void add_faces(const PlanarSection& section, Axis axis, int n_layers, Mesh& mesh) {
  const int along = static_cast<int>(axis);
  const int n = static_cast<int>(section.quads.size());
  FaceSet low{.name = end_name(along, -1)};
  FaceSet high{.name = end_name(along, 1)};
  for (int quad = 0; quad < n; ++quad) {
    low.faces.push_back({.cell = quad, .face = 4});
    high.faces.push_back({.cell = (n_layers - 1) * n + quad, .face = 5});
  }
  mesh.face_sets = {std::move(low), std::move(high)};
  for (const SectionSide& side : section.sides) {
    FaceSet set{.name = side.axis < 0 ? "side" : end_name((along + 1 + side.axis) % 3, side.sign)};
    for (int layer = 0; layer < n_layers; ++layer) {
      for (const SectionEdge& edge : side.edges) {
        set.faces.push_back(
            {.cell = layer * n + edge.quad, .face = face_over_edge[static_cast<std::size_t>(edge.edge)]});
      }
    }
    mesh.face_sets.push_back(std::move(set));
  }
}

Mesh extrude(const PlanarSection& section, Axis axis, const std::vector<Sheet>& sheets,
             std::vector<std::string> parts) {
  Mesh mesh;
  mesh.parts = std::move(parts);
  const std::vector<double> positions = layer_positions(sheets);
  const int n_node_layers = static_cast<int>(positions.size());
  mesh.nodes.reserve(positions.size() * section.nodes.size());
  for (int layer = 0; layer < n_node_layers; ++layer) {
    for (const auto& node : section.nodes) {
      mesh.nodes.push_back(turned(axis, node, positions[static_cast<std::size_t>(layer)]));
      mesh.layer_of_node.push_back(layer);
    }
  }
  add_cells(section, sheets, mesh);
  add_faces(section, axis, n_node_layers - 1, mesh);
  return mesh;
}

}  // namespace

Mesh make_mesh(const Box& box) {
  const RectangleSection section{.size = {box.size[0], box.size[1]}, .cells = {box.cells[0], box.cells[1]}};
  const int n = box.cells[2];
  Mesh mesh =
      extrude(planar_section(section), Axis::z, {{.part = 0, .thickness = box.size[2], .cells = n}}, box.part_names());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    Vec3& node = mesh.nodes[i];
    node[0] += box.centre[0];
    node[1] += box.centre[1];
    node[2] = box.centre[2] + box.size[2] * (2 * mesh.layer_of_node[i] - n) / (2.0 * n);
  }
  return mesh;
}

Mesh make_mesh(const Cylinder& cylinder) {
  return extrude(planar_section(cylinder.section), cylinder.axis,
                 {{.part = 0, .thickness = cylinder.length, .cells = cylinder.layers}}, cylinder.part_names());
}

Mesh make_mesh(const Stack& stack) {
  const std::vector<std::string> parts = stack.part_names();
  const auto sheet = [&](const StackLayer& layer) {
    const auto part = std::find(parts.begin(), parts.end(), layer.part) - parts.begin();
    return Sheet{.part = static_cast<int>(part), .thickness = layer.thickness, .cells = layer.cells};
  };
  std::vector<Sheet> sheets;
  for (int i = 0; i < stack.repeat; ++i) {
    for (const StackLayer& layer : stack.layers) sheets.push_back(sheet(layer));
  }
  if (const StackLayer* last = stack.closing_layer()) sheets.push_back(sheet(*last));
  return extrude(planar_section(stack.section), stack.axis, sheets, parts);
}

Mesh make_mesh(const MeshFile& file, const std::string& folder) {
  const bool relative = file.path.empty() || file.path.front() != '/';
  Mesh mesh = read_gmsh(relative && !folder.empty() ? folder + "/" + file.path : file.path);
  for (Vec3& node : mesh.nodes) {
    for (double& coordinate : node) coordinate *= file.scale;
  }
  return mesh;
}

}  // namespace muldi::fem
