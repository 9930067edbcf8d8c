#pragma once
/// A round bar of equal layers.
#include <string>
#include <string_view>
#include <vector>

#include "base/describe.hpp"
#include "fem/mesh/generators.hpp"

namespace muldi::fem {

/// From the origin along the axis; faces e.g. z- z+ side, of a quarter also x- y- (the planes of symmetry).
struct Cylinder {
  static constexpr std::string_view name = "cylinder";
  static constexpr std::string_view doc =
      "a round bar of equal layers, from the origin along its axis; faces at its ends (z-, z+ along z), side, and of a "
      "quarter its planes of symmetry (x-, y- along z)";

  RoundSection section{};
  double length = 0.0;
  Axis axis = Axis::z;
  int layers = 1;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    RoundSection::describe(self.section, visit);
    visit(Field{.key = "length", .doc = "length along the axis", .unit = dimension::length, .range = positive},
          self.length);
    visit(Field{.key = "axis", .doc = "axis in the mesh's own frame", .need = Need::optional}, self.axis);
    visit(Field{.key = "layers", .doc = "layers of cells along the axis", .range = {.min = 1.0, .max = 1e6}},
          self.layers);
  }
  friend bool operator==(const Cylinder&, const Cylinder&) = default;

  std::vector<std::string> face_names() const { return extruded_faces(axis, section); }
  std::vector<std::string> part_names() const { return {std::string(default_part)}; }
  double n_cells() const { return section.n_cells() * layers; }
  std::string why_invalid() const {
    const std::string why = section.why_invalid();
    return why.empty() ? why_too_large(n_cells()) : why;
  }
};

}  // namespace muldi::fem
