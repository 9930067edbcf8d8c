/// golden_tolerances FILE GLOB RTOL ATOL REASON: writes the attributes rtol, atol (unless `-`) and tolerance_reason to
/// the data sets that match; exit code 1 if none does. `muldi-sim compare` follows them (results/compare.hpp).
#include <fnmatch.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "results/hdf5_file.hpp"

namespace {

using muldi::results::hdf5::Access;
using muldi::results::hdf5::File;

int set_tolerances(const std::vector<std::string>& arguments) {
  const std::string& pattern = arguments[2];
  File file = File::open(arguments[1], Access::write);
  int n_sets = 0;
  for (const std::string& path : file.data_sets()) {
    if (fnmatch(pattern.c_str(), path.c_str(), 0) != 0) continue;
    ++n_sets;
    if (arguments[3] != "-") file.set_attribute({.object = path, .name = "rtol", .value = std::stod(arguments[3])});
    if (arguments[4] != "-") file.set_attribute({.object = path, .name = "atol", .value = std::stod(arguments[4])});
    file.set_attribute({.object = path, .name = "tolerance_reason", .value = arguments[5]});
  }
  file.close();
  if (n_sets == 0) std::fprintf(stderr, "%s has no data set '%s'\n", arguments[1].c_str(), pattern.c_str());
  return n_sets == 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv, argv + argc);
  if (arguments.size() != 6) {
    std::fputs("usage: golden_tolerances FILE GLOB RTOL|- ATOL|- REASON\n", stderr);
    return 2;
  }
  try {
    return set_tolerances(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
