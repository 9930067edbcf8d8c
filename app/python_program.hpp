#pragma once
/// The programs in Python beside ours: plot and report.
#include <string>
#include <vector>

namespace muldi::app {

/// Becomes the Python program of this name, whose exit code is then that of the process; `input` is its standard input.
/// It is looked for in share/muldi-sim/look of the installation to which this program belongs, then in tools/look of
/// the source tree that it was built from. Debian's Python runs it, or that of the environment variable MULDI_PYTHON.
/// Throws EnvironmentError if there is no such program, or no Python.
[[noreturn]] void become_python(const std::string& name, const std::vector<std::string>& arguments,
                                const std::string& input = {});

}  // namespace muldi::app
