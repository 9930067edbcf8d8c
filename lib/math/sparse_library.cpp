#include "math/sparse_library.hpp"

#include <dlfcn.h>

#include "base/error.hpp"
#include "base/text.hpp"

namespace muldi::math {

SparseLibrary::SparseLibrary(std::string file) : file_(std::move(file)) {
  library_ = ::dlopen(file_.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library_ == nullptr) {
    throw base::EnvironmentError(
        base::format("the linear solver needs {}, which is not installed: on Debian, apt-get install "
                     "libsuitesparse-dev",
                     file_));
  }
  if (void* const threads = ::dlsym(library_, "openblas_set_num_threads"); threads != nullptr) {
    reinterpret_cast<void (*)(int)>(threads)(1);
  }
}

void* SparseLibrary::address_of(const char* symbol) const {
  void* const address = ::dlsym(library_, symbol);
  if (address == nullptr) throw base::EnvironmentError(base::format("{} has no function {}", file_, symbol));
  return address;
}

void SparseLibrary::keep_to_one_thread() {
  static void* const set_levels = ::dlsym(RTLD_DEFAULT, "omp_set_max_active_levels");
  if (set_levels != nullptr) reinterpret_cast<void (*)(int)>(set_levels)(0);
}

}  // namespace muldi::math
