#pragma once
/// SuiteSparse's large libraries, opened by the first matrix that wants them: runs without one start without them.
#include <string>

namespace muldi::math {

class SparseLibrary {
 public:
  /// Opens a shared library, e.g. "libcholmod.so.3", and keeps its BLAS to one thread; EnvironmentError if it is not
  /// installed.
  explicit SparseLibrary(std::string file);

  /// EnvironmentError if the library has no such function.
  template <class Function>
  void find(const char* symbol, Function*& function) const {
    function = reinterpret_cast<Function*>(address_of(symbol));
  }

  /// To be called before a factorisation, on its thread: CHOLMOD would open four threads whatever it is told.
  static void keep_to_one_thread();

 private:
  void* address_of(const char* symbol) const;

  std::string file_;
  void* library_ = nullptr;
};

}  // namespace muldi::math
