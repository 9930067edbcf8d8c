#include "base/build_info.hpp"

#include "base/build_commit.hpp"
#include "base/build_facts.hpp"

namespace muldi::base {

const BuildInfo& build_info() {
  static constexpr BuildInfo info{.version = MULDI_BUILD_VERSION,
                                  .commit = MULDI_BUILD_COMMIT,
                                  .compiler = MULDI_BUILD_COMPILER,
                                  .flags = MULDI_BUILD_FLAGS,
                                  .libraries = {{{"CLI11", MULDI_BUILD_CLI11},
                                                 {"Eigen", MULDI_BUILD_EIGEN},
                                                 {"fmt", MULDI_BUILD_FMT},
                                                 {"HDF5", MULDI_BUILD_HDF5},
                                                 {"muParser", MULDI_BUILD_MUPARSER},
                                                 {"spdlog", MULDI_BUILD_SPDLOG},
                                                 {"SuiteSparse", MULDI_BUILD_SUITESPARSE},
                                                 {"yaml-cpp", MULDI_BUILD_YAML_CPP}}}};
  return info;
}

}  // namespace muldi::base
