#pragma once
/// XDMF side files, by which ParaView opens the fields of a result file.
///
/// Version 2 of the format: a temporal collection of unstructured grids of hexahedra for each solid, which point into
/// the HDF5 file by its name without folder. The geometry of a time is the recorded position, or the reference where
/// that was not asked for; with positions the displacement is computed by the reader. Bodies, muscles and springs are
/// collections of boxes and lines, see xdmf_drawing.hpp.
#include <string>
#include <vector>

#include "results/drawing.hpp"

namespace muldi::results {

/// Writes `<stem>.xdmf` beside a result file: fields and drawing of the dynamics, or those of the statics where there
/// are no others; with both, those of the statics go to `<stem>.statics.xdmf`. Returns the paths written: none if the
/// file holds no rows of fields and there is nothing to draw. The file may be closed or under recording. InputError if
/// the result file cannot be read, EnvironmentError if the side file cannot be written.
std::vector<std::string> write_xdmf(const std::string& result_path, const Drawing& drawing = {});

}  // namespace muldi::results
