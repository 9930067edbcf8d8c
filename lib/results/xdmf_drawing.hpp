#pragma once
/// Bodies, muscles and springs as grids of an XDMF side file.
#include <string>

#include "results/drawing.hpp"
#include "results/hdf5_file.hpp"

namespace muldi::results {

/// One temporal collection for the bodies (boxes, with velocity and number), one for each folder of lines (muscles,
/// springs: straight lines with their scalars), at no more than 250 rows evenly chosen, the last one among them. The
/// geometry stands in the text, since no data set holds it; fields of lines are single numbers. Rows of `prefix`
/// (empty, or `statics/`); empty if there are none.
std::string drawing_grids(const hdf5::File& file, const Drawing& drawing, const std::string& prefix);

}  // namespace muldi::results
