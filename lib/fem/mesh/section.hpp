#pragma once
/// Cross-sections of extruded meshes: what a scene says of them.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/describe.hpp"

namespace muldi::fem {

enum class SectionPart { full, quarter };

inline std::span<const base::Word<SectionPart>> words(SectionPart) {
  static constexpr base::Word<SectionPart> all[] = {
      {.word = "full", .value = SectionPart::full, .doc = "the whole section"},
      {.word = "quarter",
       .value = SectionPart::quarter,
       .doc = "the quarter between the two positive axes of the section, with two planes of symmetry"},
  };
  return all;
}

enum class Rim { straight, circle };

inline std::span<const base::Word<Rim>> words(Rim) {
  static constexpr base::Word<Rim> all[] = {
      {.word = "circle", .value = Rim::circle, .doc = "all nodes of the rim on the circle"},
      {.word = "straight", .value = Rim::straight, .doc = "the rim stays the regular octagon inside the circle"},
  };
  return all;
}

enum class Axis { x, y, z };

inline std::span<const base::Word<Axis>> words(Axis) {
  static constexpr base::Word<Axis> all[] = {
      {.word = "x", .value = Axis::x, .doc = "x axis of the mesh"},
      {.word = "y", .value = Axis::y, .doc = "y axis of the mesh"},
      {.word = "z", .value = Axis::z, .doc = "z axis of the mesh"},
  };
  return all;
}

/// A round section: either the octagon of four quadrangles, halved again and again, or a square core with rings.
struct RoundSection {
  static constexpr std::string_view name = "cylinder";
  static constexpr std::string_view doc = "a disc";

  double diameter = 0.0;
  std::optional<int> section_cells = {};  ///< either this, or core and rings
  std::optional<int> core = {};
  std::optional<int> rings = {};
  SectionPart part = SectionPart::full;
  Rim rim = Rim::circle;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "diameter", .doc = "diameter", .unit = dimension::length, .range = positive}, self.diameter);
    visit(Field{.key = "section_cells",
                .doc = "cells of the full section: 4 (eight nodes of a regular octagon and the centre), 16, 64, ...",
                .range = {.min = 4.0, .max = 262144.0},
                .need = optional},
          self.section_cells);
    visit(Field{.key = "core",
                .doc = "instead of section_cells: cells along an edge of the square core of one quarter",
                .range = {.min = 1.0, .max = 1000.0},
                .need = optional},
          self.core);
    visit(Field{.key = "rings",
                .doc = "with core: rings around it, each of 2 core cells a quarter",
                .range = {.min = 1.0, .max = 1000.0},
                .need = optional},
          self.rings);
    visit(Field{.key = "part", .doc = "how much of the section is meshed", .need = optional}, self.part);
    visit(Field{.key = "rim", .doc = "where the nodes of the rim are", .need = optional}, self.rim);
  }
  friend bool operator==(const RoundSection&, const RoundSection&) = default;

  /// Halvings of the octagon; -1 if section_cells is no power of four.
  int n_halvings() const {
    int n = 0;
    for (int cells = section_cells.value_or(0); cells > 4; cells /= 4) {
      if (cells % 4 != 0) return -1;
      ++n;
    }
    return section_cells.value_or(0) == 4 << 2 * n ? n : -1;
  }
  /// What makes no mesh, for people; empty if all is well.
  std::string why_invalid() const {
    if (section_cells && (core || rings)) return "give either section_cells, or core and rings";
    if (!section_cells && !(core && rings)) return "needs section_cells, or core and rings";
    if (section_cells && n_halvings() < 0) {
      return "section_cells must be 4, 16, 64, ..., got " + std::to_string(*section_cells);
    }
    return {};
  }
  /// Number of quadrangles.
  double n_cells() const {
    const double n = section_cells ? *section_cells : 4.0 * *core * (*core + 2.0 * *rings);
    return part == SectionPart::quarter ? 0.25 * n : n;
  }
};

/// A rectangle around the axis.
struct RectangleSection {
  static constexpr std::string_view name = "box";
  static constexpr std::string_view doc = "a rectangle around the axis";

  std::array<double, 2> size = {};
  std::array<int, 2> cells = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(
        Field{.key = "size",
              .doc = "edges along the two axes that follow the mesh's axis (y, z after x; z, x after y; x, y after z)",
              .unit = dimension::length,
              .range = positive},
        self.size);
    visit(Field{.key = "cells", .doc = "cells along these edges", .range = {.min = 1.0, .max = 1e5}}, self.cells);
  }
  friend bool operator==(const RectangleSection&, const RectangleSection&) = default;

  std::string why_invalid() const { return {}; }
  double n_cells() const { return static_cast<double>(cells[0]) * cells[1]; }
};

using SectionTypes = base::TypeList<RoundSection, RectangleSection>;

}  // namespace muldi::fem
