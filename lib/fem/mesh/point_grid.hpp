#pragma once
/// Finds the nodes of a mesh in a box.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "fem/mesh/mesh.hpp"

namespace muldi::fem {

/// Bins of about one node each over the bounds of the mesh.
class PointGrid {
 public:
  explicit PointGrid(const Mesh& mesh) : mesh_(mesh), bounds_(bounds_of(mesh)) {
    const double size = std::max(bounds_.diagonal(), 1e-300);
    double volume = 1.0;
    for (std::size_t i = 0; i < 3; ++i) volume *= std::max(bounds_.high[i] - bounds_.low[i], 1e-6 * size);
    const double n_nodes = static_cast<double>(std::max<std::size_t>(mesh.nodes.size(), 1));
    step_ = std::cbrt(volume / n_nodes);
    const auto bins = [&](std::size_t i) { return std::floor((bounds_.high[i] - bounds_.low[i]) / step_) + 1.0; };
    while (bins(0) * bins(1) * bins(2) > 8.0 * n_nodes) step_ *= 1.25;  // thin meshes
    for (std::size_t i = 0; i < 3; ++i) n_[i] = static_cast<int>(bins(i));
    start_.assign(static_cast<std::size_t>(n_[0]) * n_[1] * n_[2] + 1, 0);
    for (const Vec3& node : mesh.nodes) ++start_[bin(node) + 1];
    for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
    order_.resize(mesh.nodes.size());
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for (int node = 0; node < mesh.n_nodes(); ++node) {
      order_[static_cast<std::size_t>(next[bin(mesh.nodes[static_cast<std::size_t>(node)])]++)] = node;
    }
  }

  /// Calls visit(node) for the nodes in the box widened by `margin`, in a fixed order.
  template <class Visit>
  void for_each_in(const Bounds& box, double margin, Visit visit) const {
    std::array<int, 3> low{};
    std::array<int, 3> high{};
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = index(box.low[i] - margin, i);
      high[i] = index(box.high[i] + margin, i);
    }
    for (int k = low[2]; k <= high[2]; ++k) {
      for (int j = low[1]; j <= high[1]; ++j) {
        // Bins along x stand side by side.
        const int first = start_[bin(low[0], j, k)];
        const int last = start_[bin(high[0], j, k) + 1];
        for (int at = first; at < last; ++at) {
          const int node = order_[static_cast<std::size_t>(at)];
          const Vec3& x = mesh_.nodes[static_cast<std::size_t>(node)];
          bool inside = true;
          for (std::size_t i = 0; i < 3; ++i) {
            inside = inside && x[i] >= box.low[i] - margin && x[i] <= box.high[i] + margin;
          }
          if (inside) visit(node);
        }
      }
    }
  }

 private:
  int index(double x, std::size_t i) const {
    return static_cast<int>(std::clamp(std::floor((x - bounds_.low[i]) / step_), 0.0, n_[i] - 1.0));
  }
  std::size_t bin(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(n_[1]) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(n_[0]) +
           static_cast<std::size_t>(i);
  }
  std::size_t bin(const Vec3& x) const { return bin(index(x[0], 0), index(x[1], 1), index(x[2], 2)); }

  const Mesh& mesh_;
  Bounds bounds_;
  double step_ = 1.0;
  std::array<int, 3> n_{1, 1, 1};
  std::vector<int> start_;
  std::vector<int> order_;
};

}  // namespace muldi::fem
