#pragma once
/// Quadrangles of a section in its own plane.
#include <array>
#include <vector>

#include "fem/mesh/section.hpp"

namespace muldi::fem {

/// An edge of a quadrangle: from its node `edge` to the next.
struct SectionEdge {
  int quad = 0;
  int edge = 0;
};

/// A named part of the section's boundary.
struct SectionSide {
  int axis = -1;  ///< 0, 1: at the low (sign -1) or high (sign 1) end of this axis of the section; -1: the round side
  int sign = -1;
  std::vector<SectionEdge> edges = {};
};

struct PlanarSection {
  std::vector<std::array<double, 2>> nodes = {};
  std::vector<std::array<int, 4>> quads = {};  ///< counterclockwise
  std::vector<SectionSide> sides = {};
};

/// The octagon's quadrangles halved n times, or core and rings; the axes of the section point at rim nodes.
///
/// Octagon: with the rim straight each quadrangle is halved in its bilinear map and the area stays 2 sqrt(2) R^2; with
/// the rim on the circle its nodes stand at equal angles and the inner ones follow by transfinite interpolation
/// (Coons), so that the area is that of the regular polygon of the rim. Core and rings: the core is a square of half
/// edge R n / (n + rings), at most 0.55 R; the rings run straight from its edges to points at equal angles (circle) or
/// distances (straight) on the rim.
PlanarSection planar_section(const RoundSection& section);
PlanarSection planar_section(const RectangleSection& section);
inline PlanarSection planar_section(const base::VariantOf<SectionTypes>& section) {
  return std::visit([](const auto& shape) { return planar_section(shape); }, section);
}

}  // namespace muldi::fem
