// What the mesh of a muscle can be.
#include "scene/meshed_muscle.hpp"

#include <cmath>

namespace muldi::scene {

int MeshedMuscle::cells_along_edge() const {
  const int n = static_cast<int>(std::lround(std::sqrt(section_cells)));
  return n * n == section_cells ? n : 0;
}

std::string MeshedMuscle::why_no_mesh(const muscles::Section& said) const {
  const muscles::Section& section = replacements.section.value_or(said);
  if (std::holds_alternative<muscles::RoundSection>(section.shape)) {
    return fem::RoundSection{.diameter = 1.0, .section_cells = section_cells}.why_invalid();
  }
  if (cells_along_edge() > 0) return {};
  return "section_cells of a square must be 1, 4, 9, 16, ..., got " + std::to_string(section_cells);
}

}  // namespace muldi::scene
