#pragma once
/// XDMF side files, by which ParaView opens the fields of a result file.
///
/// Version 2 of the format: a temporal collection of unstructured grids of hexahedra for each solid, which point into
/// the HDF5 file by its name without folder. The geometry of a time is the recorded position, or the reference where
/// that was not asked for.
#include <string>
#include <vector>

namespace muldi::results {

/// Writes `<stem>.xdmf` beside a result file that is closed: the fields of the dynamics, or those of the statics where
/// there are no others; with both, those of the statics go to `<stem>.statics.xdmf`. Returns the paths written: none if
/// the file holds no rows of fields.
/// InputError if the result file cannot be read, EnvironmentError if the side file cannot be written.
std::vector<std::string> write_xdmf(const std::string& result_path);

}  // namespace muldi::results
