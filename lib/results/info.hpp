#pragma once
/// What `info out.h5` says.
#include <string>

namespace muldi::results {

/// Status, title, provenance, sizes, final values with units, solver statistics, wall time a phase; ends with a
/// newline. Wall times are the attributes `wall_time.<phase>` of the file, in seconds. Throws InputError if the file
/// cannot be read.
std::string info(const std::string& path);

}  // namespace muldi::results
