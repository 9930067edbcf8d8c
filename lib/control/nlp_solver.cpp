#include "control/nlp_solver.hpp"

#include <dlfcn.h>

#include <array>
#include <cstdlib>
#include <filesystem>

namespace muldi::control {
namespace {

constexpr const char* module_name = "libmuldi_ipopt.so";

/// The place of an installation beside the program, then that of the build tree.
std::array<std::string, 2> module_places() {
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  return {(program.parent_path().parent_path() / MULDI_MODULE_DIR / module_name).string(),
          std::string(MULDI_MODULE_BUILD_DIR) + "/" + module_name};
}

NlpSolver open_module(std::string& why_not) {
  // More threads of BLAS slow the small dense blocks of the factorisation down.
  ::setenv("OPENBLAS_NUM_THREADS", "1", 0);
  void* module = nullptr;
  for (const std::string& place : module_places()) {
    module = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module != nullptr) break;
  }
  if (module == nullptr) {
    const char* const error = ::dlerror();
    why_not = error == nullptr ? "the module is missing" : error;
    return nullptr;
  }
  if (void* const threads = ::dlsym(module, "openblas_set_num_threads"); threads != nullptr) {
    reinterpret_cast<void (*)(int)>(threads)(1);
  }
  const auto solver = reinterpret_cast<NlpSolver*>(::dlsym(module, "muldi_solve_nlp"));
  if (solver == nullptr) why_not = "the module has no solver";
  return solver == nullptr ? nullptr : *solver;
}

}  // namespace

NlpSolver open_nlp_solver(std::string& why_not) {
  static std::string reason;
  static const NlpSolver solver = open_module(reason);
  why_not = reason;
  return solver;
}

}  // namespace muldi::control
