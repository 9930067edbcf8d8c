#include "fem/mesh/node_order.hpp"

#include <algorithm>
#include <numeric>

namespace muldi::fem {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// Cells of each node.
class CellsOfNodes {
 public:
  explicit CellsOfNodes(const Mesh& mesh) : start_(mesh.nodes.size() + 1, 0), cells_(8 * mesh.cells.size()) {
    for (const auto& cell : mesh.cells) {
      for (const int node : cell) ++start_[at(node) + 1];
    }
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for (int cell = 0; cell < mesh.n_cells(); ++cell) {
      for (const int node : mesh.cells[at(cell)]) cells_[at(next[at(node)]++)] = cell;
    }
  }
  int n(int node) const { return start_[at(node) + 1] - start_[at(node)]; }
  template <class Visit>
  void for_each(int node, Visit visit) const {
    for (int i = start_[at(node)]; i < start_[at(node) + 1]; ++i) visit(cells_[at(i)]);
  }

 private:
  std::vector<int> start_;
  std::vector<int> cells_;
};

/// Appends the piece of `first` to `order`, level by level, nodes of few cells first; marks it in `seen`.
void append_levels(const Mesh& mesh, const CellsOfNodes& cells, int first, std::vector<char>& seen,
                   std::vector<int>& order) {
  std::size_t next = order.size();
  order.push_back(first);
  seen[at(first)] = 1;
  for (; next < order.size(); ++next) {
    const auto level = static_cast<std::ptrdiff_t>(order.size());
    cells.for_each(order[next], [&](int cell) {
      for (const int node : mesh.cells[at(cell)]) {
        if (seen[at(node)] != 0) continue;
        seen[at(node)] = 1;
        order.push_back(node);
      }
    });
    std::stable_sort(order.begin() + level, order.end(), [&](int a, int b) { return cells.n(a) < cells.n(b); });
  }
}

/// New order of the nodes: old number at each place.
std::vector<int> order_of_nodes(const Mesh& mesh) {
  const CellsOfNodes cells(mesh);
  std::vector<int> order;
  order.reserve(mesh.nodes.size());
  std::vector<char> seen(mesh.nodes.size(), 0);
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    if (seen[at(node)] != 0) continue;
    // The last node of a first pass is far from where it began: an end of the piece.
    std::vector<char> probe = seen;
    std::vector<int> pass;
    append_levels(mesh, cells, node, probe, pass);
    append_levels(mesh, cells, pass.back(), seen, order);
  }
  std::reverse(order.begin(), order.end());
  return order;
}

template <class T>
void reorder(std::vector<T>& values, const std::vector<int>& order) {
  if (values.empty()) return;
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const int old : order) sorted.push_back(values[at(old)]);
  values = std::move(sorted);
}

std::vector<int> inverse(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) place[at(order[i])] = static_cast<int>(i);
  return place;
}

}  // namespace

void order_by_neighbours(Mesh& mesh) {
  const std::vector<int> nodes = order_of_nodes(mesh);
  const std::vector<int> node_place = inverse(nodes);
  reorder(mesh.nodes, nodes);
  reorder(mesh.layer_of_node, nodes);
  reorder(mesh.labels_of_nodes, nodes);
  for (auto& cell : mesh.cells) {
    for (int& node : cell) node = node_place[at(node)];
  }
  for (NodeSet& set : mesh.node_sets) {
    for (int& node : set.nodes) node = node_place[at(node)];
    std::sort(set.nodes.begin(), set.nodes.end());
  }

  std::vector<int> cells(mesh.cells.size());
  std::iota(cells.begin(), cells.end(), 0);
  const auto least = [&](int cell) {
    return *std::min_element(mesh.cells[at(cell)].begin(), mesh.cells[at(cell)].end());
  };
  std::stable_sort(cells.begin(), cells.end(), [&](int a, int b) { return least(a) < least(b); });
  const std::vector<int> cell_place = inverse(cells);
  reorder(mesh.cells, cells);
  reorder(mesh.part_of_cell, cells);
  reorder(mesh.labels_of_cells, cells);
  for (FaceSet& set : mesh.face_sets) {
    for (CellFace& face : set.faces) face.cell = cell_place[at(face.cell)];
    std::sort(set.faces.begin(), set.faces.end(), [](const CellFace& a, const CellFace& b) {
      return a.cell != b.cell ? a.cell < b.cell : a.face < b.face;
    });
  }
}

int bandwidth(const Mesh& mesh) {
  int widest = 0;
  for (const auto& cell : mesh.cells) {
    const auto [low, high] = std::minmax_element(cell.begin(), cell.end());
    widest = std::max(widest, *high - *low);
  }
  return widest;
}

}  // namespace muldi::fem
