#include "build/squeezed_cell.hpp"

#include "fem/solid/least_stretch.hpp"

namespace muldi::build {

SqueezedCell squeezed_cell(const BuiltModel& built, const Eigen::VectorXd& q) {
  SqueezedCell least;
  for (const fem::Solid* solid : built.solids) {
    const fem::CellStretch cell = fem::least_stretch(solid->elements(), solid->positions(q));
    if (!least.name.empty() && cell.stretch >= least.stretch) continue;
    least = {.name = solid->place_of_cell(cell.cell) + " of solid '" + solid->member_of_cell(cell.cell).name + "'",
             .stretch = cell.stretch};
  }
  return least;
}

}  // namespace muldi::build
