#include "fem/mesh/planar_section.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

namespace muldi::fem {
namespace {

using Point = std::array<double, 2>;

/// Collects quadrangles whose nodes are given by position; positions that agree to 1e-9 R are one node.
class Welder {
 public:
  explicit Welder(double radius) : step_(1e-9 * radius) {}

  int node(const Point& at) {
    const auto key = [this](double x) { return std::llround(x / step_); };
    const std::int64_t i = key(at[0]);
    const std::int64_t j = key(at[1]);
    for (std::int64_t di = -1; di <= 1; ++di) {
      for (std::int64_t dj = -1; dj <= 1; ++dj) {
        const auto found = index_.find({i + di, j + dj});
        if (found != index_.end()) return found->second;
      }
    }
    const int next = static_cast<int>(section.nodes.size());
    index_[{i, j}] = next;
    section.nodes.push_back(at);
    return next;
  }

  /// n x m quadrangles of a map of the unit square, turned by quarters of a circle.
  template <class Map>
  void add_patch(int n, int m, int quarter, Map map) {
    const auto at = [&](int i, int j) {
      Point p = map(static_cast<double>(i) / n, static_cast<double>(j) / m);
      for (int turn = 0; turn < quarter; ++turn) p = {-p[1], p[0]};
      return node(p);
    };
    for (int j = 0; j < m; ++j) {
      for (int i = 0; i < n; ++i) section.quads.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }

  PlanarSection section;

 private:
  double step_;
  std::map<std::pair<std::int64_t, std::int64_t>, int> index_;
};

Point blend(const Point& a, const Point& b, double s) { return {(1 - s) * a[0] + s * b[0], (1 - s) * a[1] + s * b[1]}; }

/// The rim of the first quarter; s from 0 on the first axis to 1 on the second.
struct QuarterRim {
  double radius;
  Rim rim;

  Point operator()(double s) const {
    const double diagonal = radius / std::numbers::sqrt2;
    if (s == 0.5) return {diagonal, diagonal};
    if (s > 0.5) {  // the mirror image, to the last bit
      const Point mirrored = (*this)(1 - s);
      return {mirrored[1], mirrored[0]};
    }
    if (rim == Rim::straight) return blend({radius, 0.0}, {diagonal, diagonal}, 2 * s);
    const double angle = 0.5 * std::numbers::pi * s;
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }
};

/// One quarter of the octagon: Coons' map between two spokes and the two edges of the rim.
Point octagon_point(const QuarterRim& rim, double s, double t) {
  const Point right = rim(0.5 * t);
  const Point top = rim(1 - 0.5 * s);
  const Point p0 = rim(0);
  const Point p1 = rim(0.5);
  const Point p2 = rim(1);
  Point p{};
  for (std::size_t i = 0; i < 2; ++i) {
    const double across = s * right[i] + (1 - s) * t * p2[i];
    const double along = t * top[i] + (1 - t) * s * p0[i];
    p[i] = across + along - (s * (1 - t) * p0[i] + s * t * p1[i] + (1 - s) * t * p2[i]);
  }
  return p;
}

void add_octagon(Welder& welder, const RoundSection& section, int n_quarters) {
  const QuarterRim rim{.radius = 0.5 * section.diameter, .rim = section.rim};
  const int n = 1 << section.n_halvings();
  for (int quarter = 0; quarter < n_quarters; ++quarter) {
    welder.add_patch(n, n, quarter, [&](double s, double t) { return octagon_point(rim, s, t); });
  }
}

void add_core_and_rings(Welder& welder, const RoundSection& section, int n_quarters) {
  const double radius = 0.5 * section.diameter;
  const QuarterRim rim{.radius = radius, .rim = section.rim};
  const int n = *section.core;
  const int rings = *section.rings;
  const double edge = radius * std::min(0.55, static_cast<double>(n) / (n + rings));
  for (int quarter = 0; quarter < n_quarters; ++quarter) {
    welder.add_patch(n, n, quarter, [&](double s, double t) { return Point{edge * s, edge * t}; });
    welder.add_patch(rings, n, quarter, [&](double s, double t) { return blend({edge, edge * t}, rim(0.5 * t), s); });
    welder.add_patch(n, rings, quarter, [&](double s, double t) {
      return blend({edge * s, edge}, rim(1 - 0.5 * s), t);
    });
  }
}

/// The sides of the quadrangles that belong to one of them only.
std::vector<SectionEdge> boundary_edges(const PlanarSection& section) {
  std::map<std::pair<int, int>, int> count;
  const auto ends = [&](const SectionEdge& at) {
    const auto& quad = section.quads[static_cast<std::size_t>(at.quad)];
    const int a = quad[static_cast<std::size_t>(at.edge)];
    const int b = quad[static_cast<std::size_t>((at.edge + 1) % 4)];
    return std::pair(std::min(a, b), std::max(a, b));
  };
  std::vector<SectionEdge> all;
  for (int quad = 0; quad < static_cast<int>(section.quads.size()); ++quad) {
    for (int edge = 0; edge < 4; ++edge) all.push_back({.quad = quad, .edge = edge});
  }
  for (const SectionEdge& edge : all) ++count[ends(edge)];
  std::vector<SectionEdge> boundary;
  for (const SectionEdge& edge : all) {
    if (count[ends(edge)] == 1) boundary.push_back(edge);
  }
  return boundary;
}

}  // namespace

PlanarSection planar_section(const RoundSection& section) {
  Welder welder(0.5 * section.diameter);
  const int n_quarters = section.part == SectionPart::quarter ? 1 : 4;
  if (section.section_cells) {
    add_octagon(welder, section, n_quarters);
  } else {
    add_core_and_rings(welder, section, n_quarters);
  }
  PlanarSection result = std::move(welder.section);
  SectionSide round;
  SectionSide planes[2] = {{.axis = 0, .sign = -1}, {.axis = 1, .sign = -1}};
  const double tolerance = 1e-9 * section.diameter;
  for (const SectionEdge& edge : boundary_edges(result)) {
    const auto& quad = result.quads[static_cast<std::size_t>(edge.quad)];
    SectionSide* side = &round;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto low = [&](int k) {
        return std::abs(result.nodes[static_cast<std::size_t>(quad[static_cast<std::size_t>(k % 4)])][i]) < tolerance;
      };
      if (section.part == SectionPart::quarter && low(edge.edge) && low(edge.edge + 1)) side = &planes[i];
    }
    side->edges.push_back(edge);
  }
  result.sides.push_back(std::move(round));
  if (section.part == SectionPart::quarter) {
    for (SectionSide& plane : planes) result.sides.push_back(std::move(plane));
  }
  return result;
}

PlanarSection planar_section(const RectangleSection& section) {
  const auto [n, m] = section.cells;
  const auto centred = [](double size, int i, int n_cells) { return size * (2 * i - n_cells) / (2.0 * n_cells); };
  PlanarSection result;
  for (int j = 0; j <= m; ++j) {
    for (int i = 0; i <= n; ++i) {
      result.nodes.push_back({centred(section.size[0], i, n), centred(section.size[1], j, m)});
    }
  }
  result.sides = {{.axis = 0, .sign = -1}, {.axis = 0, .sign = 1}, {.axis = 1, .sign = -1}, {.axis = 1, .sign = 1}};
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const int quad = static_cast<int>(result.quads.size());
      const int corner = j * (n + 1) + i;
      result.quads.push_back({corner, corner + 1, corner + n + 2, corner + n + 1});
      if (i == 0) result.sides[0].edges.push_back({.quad = quad, .edge = 3});
      if (i == n - 1) result.sides[1].edges.push_back({.quad = quad, .edge = 1});
      if (j == 0) result.sides[2].edges.push_back({.quad = quad, .edge = 0});
      if (j == m - 1) result.sides[3].edges.push_back({.quad = quad, .edge = 2});
    }
  }
  return result;
}

}  // namespace muldi::fem
