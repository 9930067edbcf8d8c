#include "fem/mesh/check_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/text.hpp"
#include "fem/mesh/point_grid.hpp"

namespace muldi::fem {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// Collects sentences of one kind: the first few, then how many more there are.
class Sentences {
 public:
  Sentences(std::vector<std::string>& to, const char* more) : to_(to), more_(more) {}
  Sentences(const Sentences&) = delete;
  Sentences& operator=(const Sentences&) = delete;
  ~Sentences() {
    if (n_ > most) to_.push_back("and " + std::to_string(n_ - most) + " more " + more_);
  }
  template <class Sentence>
  void add(Sentence sentence) {
    if (n_++ < most) to_.push_back(sentence());
  }
  int n() const { return n_; }

 private:
  static constexpr int most = 5;
  std::vector<std::string>& to_;
  const char* more_;
  int n_ = 0;
};

std::string node_at(const Mesh& mesh, int node) {
  return node_name(mesh, node) + " at " + position_text(mesh.nodes[at(node)]);
}

bool numbers_are_good(const Mesh& mesh, MeshReport& report) {
  Sentences found(report.errors, "cells with such nodes");
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    const auto& nodes = mesh.cells[at(cell)];
    const auto bad = std::find_if(nodes.begin(), nodes.end(), [&](int n) { return n < 0 || n >= mesh.n_nodes(); });
    if (bad == nodes.end()) continue;
    found.add([&] { return cell_name(mesh, cell) + " names node " + std::to_string(*bad) + ", which does not exist"; });
  }
  return found.n() == 0;
}

void check_volumes(const Mesh& mesh, MeshReport& report) {
  Sentences found(report.errors, "cells of this kind");
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    double worst = std::numeric_limits<double>::infinity();
    double mean = 0.0;
    int worst_corner = 0;  // 8 to 15: Gauss points
    for (int i = 0; i < 16; ++i) {
      const double here = i < 8 ? jacobian_at_corner(mesh, cell, i) : jacobian_at_gauss_point(mesh, cell, i - 8);
      if (i >= 8) mean += 0.125 * std::abs(here);
      if (here >= worst) continue;
      worst = here;
      worst_corner = i;
    }
    constexpr double flat = 1e-10;  // of the mean: round-off of coordinates
    if (worst > flat * mean) continue;
    found.add([&] {
      const char* what = worst < -flat * mean ? " has a negative volume at " : " has no volume at ";
      const std::string where = worst_corner < 8 ? node_at(mesh, mesh.cells[at(cell)][at(worst_corner)])
                                                 : "Gauss point " + std::to_string(worst_corner - 8);
      return cell_name(mesh, cell) + what + where + " (Jacobian " + base::number_text(worst, 3) +
             "): turn or move its nodes";
    });
  }
}

void check_use(const Mesh& mesh, MeshReport& report) {
  std::vector<char> used(mesh.nodes.size(), 0);
  for (const auto& cell : mesh.cells) {
    for (const int node : cell) used[at(node)] = 1;
  }
  Sentences found(report.errors, "nodes of no cell");
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    if (used[at(node)] == 0) found.add([&] { return node_at(mesh, node) + " belongs to no cell: leave it out"; });
  }
}

void check_duplicates(const Mesh& mesh, const PointGrid& grid, double tolerance, MeshReport& report) {
  Sentences found(report.errors, "pairs of nodes at the same place");
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const Vec3& x = mesh.nodes[at(node)];
    grid.for_each_in({.low = x, .high = x}, tolerance, [&](int other) {
      if (other <= node) return;
      const Vec3& y = mesh.nodes[at(other)];
      if (std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]) > tolerance) return;
      found.add([&] {
        return node_at(mesh, node) + " and " + node_name(mesh, other) +
               " are at the same place: make them one, so that their cells hang together";
      });
    });
  }
}

/// Distance of a point from the bilinear face, with the place on it in [-1, 1]^2 (Gauss-Newton on the distance).
struct OnFace {
  double distance = 0.0;
  double s = 0.0;
  double t = 0.0;
};

OnFace project(const std::array<Vec3, 4>& corners, const Vec3& point) {
  OnFace result;
  for (int iteration = 0; iteration < 20; ++iteration) {
    const double s = result.s;
    const double t = result.t;
    const double weights[4] = {0.25 * (1 - s) * (1 - t), 0.25 * (1 + s) * (1 - t), 0.25 * (1 + s) * (1 + t),
                               0.25 * (1 - s) * (1 + t)};
    Vec3 gap{};
    Vec3 along_s{};
    Vec3 along_t{};
    for (std::size_t i = 0; i < 3; ++i) {
      gap[i] = point[i];
      for (std::size_t k = 0; k < 4; ++k) gap[i] -= weights[k] * corners[k][i];
      along_s[i] = 0.25 * ((1 - t) * (corners[1][i] - corners[0][i]) + (1 + t) * (corners[2][i] - corners[3][i]));
      along_t[i] = 0.25 * ((1 - s) * (corners[3][i] - corners[0][i]) + (1 + s) * (corners[2][i] - corners[1][i]));
    }
    const auto dot = [](const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    result.distance = std::sqrt(dot(gap, gap));
    const double ss = dot(along_s, along_s);
    const double st = dot(along_s, along_t);
    const double tt = dot(along_t, along_t);
    const double determinant = ss * tt - st * st;
    if (!(determinant > 0.0)) return {.distance = std::numeric_limits<double>::infinity()};
    const double ds = (tt * dot(along_s, gap) - st * dot(along_t, gap)) / determinant;
    const double dt = (ss * dot(along_t, gap) - st * dot(along_s, gap)) / determinant;
    result.s = std::clamp(s + ds, -2.0, 2.0);
    result.t = std::clamp(t + dt, -2.0, 2.0);
    if (std::abs(ds) + std::abs(dt) < 1e-12) break;
  }
  return result;
}

void check_hanging(const Mesh& mesh, const PointGrid& grid, double tolerance, MeshReport& report) {
  Sentences found(report.errors, "hanging nodes");
  std::vector<char> reported(mesh.nodes.size(), 0);
  for (const CellFace& face : boundary_faces(mesh)) {
    const std::array<int, 4> nodes = face_nodes(mesh, face);
    std::array<Vec3, 4> corners{};
    Bounds box{.low = mesh.nodes[at(nodes[0])], .high = mesh.nodes[at(nodes[0])]};
    for (std::size_t k = 0; k < 4; ++k) {
      corners[k] = mesh.nodes[at(nodes[k])];
      for (std::size_t i = 0; i < 3; ++i) {
        box.low[i] = std::min(box.low[i], corners[k][i]);
        box.high[i] = std::max(box.high[i], corners[k][i]);
      }
    }
    grid.for_each_in(box, tolerance, [&](int node) {
      if (reported[at(node)] != 0 || std::find(nodes.begin(), nodes.end(), node) != nodes.end()) return;
      const OnFace on = project(corners, mesh.nodes[at(node)]);
      constexpr double beside = 1.0 + 1e-6;
      if (on.distance > tolerance || std::abs(on.s) > beside || std::abs(on.t) > beside) return;
      const bool at_corner = std::abs(on.s) > 2 - beside && std::abs(on.t) > 2 - beside;
      if (at_corner) return;  // the same place as a node of the face
      reported[at(node)] = 1;
      const bool on_edge = std::abs(on.s) > 2 - beside || std::abs(on.t) > 2 - beside;
      found.add([&] {
        return node_at(mesh, node) + " hangs: it lies inside " + (on_edge ? "an edge" : "a face") + " of " +
               cell_name(mesh, face.cell) + ", which does not have it";
      });
    });
  }
}

void note_pieces(const Mesh& mesh, MeshReport& report) {
  std::vector<int> root(mesh.nodes.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int node) {
    while (root[at(node)] != node) {
      root[at(node)] = root[at(root[at(node)])];
      node = root[at(node)];
    }
    return node;
  };
  for (const auto& cell : mesh.cells) {
    for (const int node : cell) root[at(find(node))] = find(cell[0]);
  }
  std::vector<int> first_cells;
  std::vector<char> seen(mesh.nodes.size(), 0);
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    char& mark = seen[at(find(mesh.cells[at(cell)][0]))];
    if (mark == 0) first_cells.push_back(cell);
    mark = 1;
  }
  if (first_cells.size() < 2) return;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min<std::size_t>(first_cells.size(), 5); ++i) {
    names.push_back(cell_name(mesh, first_cells[i]));
  }
  if (first_cells.size() > names.size()) names.emplace_back("...");
  report.notes.push_back("the mesh is in " + std::to_string(first_cells.size()) +
                         " pieces that do not hang together, with " + base::joined(names));
}

}  // namespace

MeshReport check_mesh(const Mesh& mesh) {
  MeshReport report{.errors = {}, .notes = mesh.notes};
  if (mesh.cells.empty()) report.errors.emplace_back("the mesh has no cells");
  if (mesh.cells.empty() || !numbers_are_good(mesh, report)) return report;
  check_volumes(mesh, report);
  check_use(mesh, report);
  // Of the whole mesh, since a cell may have an edge without length.
  const double tolerance = std::max(1e-9 * bounds_of(mesh).diagonal(), 1e-4 * shortest_edge(mesh));
  const PointGrid grid(mesh);
  check_duplicates(mesh, grid, tolerance, report);
  check_hanging(mesh, grid, tolerance, report);
  note_pieces(mesh, report);
  return report;
}

}  // namespace muldi::fem
