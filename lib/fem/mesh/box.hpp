#pragma once
/// A box of equal cells.
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/describe.hpp"
#include "fem/mesh/generators.hpp"

namespace muldi::fem {

/// Faces x- x+ y- y+ z- z+; node layers along z.
struct Box {
  static constexpr std::string_view name = "box";
  static constexpr std::string_view doc = "a box of equal cells; faces x-, x+, y-, y+, z-, z+";

  base::Vec3 size{};
  std::array<int, 3> cells{};
  base::Vec3 centre{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "size", .doc = "edges along x, y, z", .unit = dimension::length, .range = positive}, self.size);
    visit(Field{.key = "cells", .doc = "cells along x, y, z", .range = {.min = 1.0, .max = 1e6}}, self.cells);
    visit(Field{.key = "centre",
                .doc = "centre in the mesh's own frame",
                .unit = dimension::length,
                .need = Need::optional},
          self.centre);
  }
  friend bool operator==(const Box&, const Box&) = default;

  std::vector<std::string> face_names() const { return {"x-", "x+", "y-", "y+", "z-", "z+"}; }
  std::vector<std::string> part_names() const { return {std::string(default_part)}; }
  double n_cells() const { return static_cast<double>(cells[0]) * cells[1] * cells[2]; }
  std::string why_invalid() const { return why_too_large(n_cells()); }
};

}  // namespace muldi::fem
