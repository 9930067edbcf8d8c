#include "fem/solid/mortar.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace muldi::fem {
namespace {

/// Sine of the angle below which two edges are one straight line.
constexpr double straight = 1e-6;

/// A face or an edge of the attached mesh on the other one.
struct Element {
  std::vector<int> nodes;
  std::vector<OverlapPoint> points;
};

/// The conditions of one kind of elements, edges or faces.
class Conditions {
 public:
  /// `placed`: nodes that have their places already.
  Conditions(const std::vector<FaceNodes>& others, const std::set<int>& placed) : others_(others), placed_(placed) {}

  /// An element all of whose nodes are placed has no multipliers.
  void add(const Element& element) {
    const auto n = static_cast<Eigen::Index>(element.nodes.size());
    if (std::all_of(element.nodes.begin(), element.nodes.end(), [&](int node) { return is_placed(node); })) return;
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
    for (const OverlapPoint& point : element.points) {
      const Eigen::Map<const Eigen::VectorXd> N(point.own.data(), n);
      m += point.weight * N * N.transpose();
    }
    // int psi_a N_b = 0 for b != a, and the psi_a add up to 1.
    const Eigen::VectorXd w = m.rowwise().sum();
    const Eigen::MatrixXd multipliers = shares(element).transpose() * w.asDiagonal() * m.inverse();
    for (Eigen::Index i = 0; i < n; ++i) {
      const int node = element.nodes[static_cast<std::size_t>(i)];
      if (is_placed(node)) continue;
      Row& row = rows_[node];
      for (Eigen::Index b = 0; b < n; ++b) {
        const int other = element.nodes[static_cast<std::size_t>(b)];
        const double integral = multipliers.row(i).dot(m.col(b));
        if (other == node) row.own += integral;
        if (is_placed(other)) row.sum[other] -= integral;
      }
      for (const OverlapPoint& point : element.points) {
        const double mu = multipliers.row(i).dot(Eigen::Map<const Eigen::VectorXd>(point.own.data(), n));
        for (std::size_t a = 0; a < 4; ++a) {
          row.sum[others_[static_cast<std::size_t>(point.other)][a]] += point.weight * mu * point.others[a];
        }
      }
    }
  }

  /// Appends the sums of the nodes that have conditions.
  void give(std::vector<NodeSum>& sums) const {
    for (const auto& [node, row] : rows_) {
      NodeSum& one = sums.emplace_back(NodeSum{.node = node});
      for (const auto& [to, integral] : row.sum) {
        one.to.push_back(to);
        one.weights.push_back(integral / row.own);
      }
    }
  }

 private:
  struct Row {
    double own = 0.0;
    std::map<int, double> sum;
  };

  bool is_placed(int node) const { return placed_.count(node) != 0; }

  /// (a, i): the part of the dual function of node a in the multiplier of node i. That of a placed node goes to its
  /// neighbours in the element, or to all of it where none of them has a multiplier.
  Eigen::MatrixXd shares(const Element& element) const {
    const std::size_t n = element.nodes.size();
    Eigen::MatrixXd parts = Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
    for (std::size_t a = 0; a < n; ++a) {
      if (!is_placed(element.nodes[a])) continue;
      std::vector<std::size_t> takers;
      for (const std::size_t i : {(a + 1) % n, (a + n - 1) % n}) {
        if (!is_placed(element.nodes[i])) takers.push_back(i);
      }
      for (std::size_t i = 0; i < n && takers.empty(); ++i) {
        if (!is_placed(element.nodes[i])) takers.push_back(i);
      }
      const auto row = static_cast<Eigen::Index>(a);
      parts.row(row).setZero();
      for (const std::size_t i : takers) {
        parts(row, static_cast<Eigen::Index>(i)) += 1.0 / static_cast<double>(takers.size());
      }
    }
    return parts;
  }

  const std::vector<FaceNodes>& others_;
  const std::set<int>& placed_;
  std::map<int, Row> rows_;
};

/// An edge of the outline, and the face that it belongs to.
struct Side {
  int a = 0;
  int b = 0;
  const FaceNodes* face = nullptr;
};

/// Edges of one face only.
std::vector<Side> outline(const std::vector<FaceNodes>& faces) {
  std::map<std::pair<int, int>, std::pair<int, Side>> edges;
  for (const FaceNodes& face : faces) {
    for (std::size_t k = 0; k < 4; ++k) {
      const int a = face[k];
      const int b = face[(k + 1) % 4];
      auto& [count, side] = edges[{std::min(a, b), std::max(a, b)}];
      ++count;
      side = {a, b, &face};
    }
  }
  std::vector<Side> sides;
  for (const auto& [nodes, edge] : edges) {
    if (edge.first == 1) sides.push_back(edge.second);
  }
  return sides;
}

/// Nodes of the outline that are not inside one of its straight sides.
std::set<int> corners_of(const Eigen::VectorXd& X, const std::vector<Side>& sides) {
  std::map<int, std::vector<int>> neighbours;
  for (const Side& side : sides) {
    neighbours[side.a].push_back(side.b);
    neighbours[side.b].push_back(side.a);
  }
  const auto at = [&X](int node) { return X.segment<3>(3 * static_cast<Eigen::Index>(node)); };
  std::set<int> corners;
  for (const auto& [node, ends] : neighbours) {
    bool inside = ends.size() == 2;
    if (inside) {
      const Eigen::Vector3d one = (at(ends[0]) - at(node)).normalized();
      const Eigen::Vector3d two = (at(ends[1]) - at(node)).normalized();
      inside = one.cross(two).norm() < straight && one.dot(two) < 0.0;
    }
    if (!inside) corners.insert(node);
  }
  return corners;
}

}  // namespace

std::vector<NodeSum> mortar_sums(const Eigen::VectorXd& X, const std::vector<FaceNodes>& attached,
                                 const std::vector<FaceNodes>& others, double tolerance, const std::set<int>& placed) {
  const FaceOverlap overlap(X, others, tolerance);
  if (std::all_of(attached.begin(), attached.end(), [&](const auto& face) { return overlap.one_holds(face); })) {
    return {};
  }
  const std::vector<Side> sides = outline(attached);
  std::set<int> corners = corners_of(X, sides);
  corners.insert(placed.begin(), placed.end());
  std::set<int> on_outline = placed;
  Conditions along_sides(others, corners);
  for (const Side& side : sides) {
    auto points = overlap.on_edge(side.a, side.b, *side.face);
    if (!points) return {};
    along_sides.add({.nodes = {side.a, side.b}, .points = std::move(*points)});
    on_outline.insert({side.a, side.b});
  }
  Conditions on_faces(others, on_outline);
  for (const FaceNodes& face : attached) {
    auto points = overlap.on_face(face);
    if (!points) return {};
    on_faces.add({.nodes = {face.begin(), face.end()}, .points = std::move(*points)});
  }
  std::vector<NodeSum> sums;
  along_sides.give(sums);
  on_faces.give(sums);
  return sums;
}

}  // namespace muldi::fem
