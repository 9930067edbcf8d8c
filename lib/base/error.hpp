#pragma once
/// The three kinds of exception (architecture, section 3): wrong input, failing environment, broken contract.
/// Outcomes of solvers are values, never exceptions.
#include <stdexcept>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"

namespace muldi::base {

/// The input is wrong: carries every diagnostic that was found, located in the file that was read (exit code 2).
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Diagnostic> diagnostics);
  /// One diagnostic without a place in a file (options of the command line, a missing file).
  explicit InputError(std::string message);
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

/// The environment failed: cannot write, disk full, missing module (exit code 4).
class EnvironmentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A contract inside the program is broken: a bug, never the user's fault.
class ContractError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws ContractError with the place; use MULDI_EXPECT.
[[noreturn]] void contract_broken(const char* condition, const char* file, int line, const char* what);

}  // namespace muldi::base

/// States a precondition that callers inside the program must keep.
#define MULDI_EXPECT(condition, what) \
  ((condition) ? static_cast<void>(0) : ::muldi::base::contract_broken(#condition, __FILE__, __LINE__, what))
