#pragma once
/// What is shared by the fields of the mesh generators.
#include <string>
#include <string_view>
#include <vector>

#include "base/text.hpp"
#include "fem/mesh/section.hpp"

namespace muldi::fem {

/// The name of the part of a mesh whose generator or file names none.
inline constexpr std::string_view default_part = "solid";

/// More cells than this are refused: a slip of the keyboard, or a machine of another kind.
inline constexpr double most_cells = 2e7;

/// Says that a mesh would be too large; empty if it is not.
inline std::string why_too_large(double n_cells) {
  if (n_cells <= most_cells) return {};
  return "makes " + base::number_text(n_cells, 3) + " cells, at most " + base::number_text(most_cells) + " are built";
}

/// `x-`, `x+`, ... : the end of the mesh below (sign -1) or above (sign 1) along an axis (0, 1, 2).
inline std::string end_name(int axis, int sign) { return std::string(1, "xyz"[axis]) + (sign < 0 ? '-' : '+'); }

/// Names of the faces of a section that is extruded along an axis, ends first.
inline std::vector<std::string> extruded_faces(Axis axis, const base::VariantOf<SectionTypes>& section) {
  const int along = static_cast<int>(axis);
  std::vector<std::string> names{end_name(along, -1), end_name(along, 1)};
  const int first = (along + 1) % 3;
  const int second = (along + 2) % 3;
  if (const auto* round = std::get_if<RoundSection>(&section)) {
    names.emplace_back("side");
    if (round->part == SectionPart::quarter) {
      names.push_back(end_name(first, -1));
      names.push_back(end_name(second, -1));
    }
    return names;
  }
  for (const int direction : {first, second}) {
    for (const int sign : {-1, 1}) names.push_back(end_name(direction, sign));
  }
  return names;
}

}  // namespace muldi::fem
