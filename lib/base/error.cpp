#include "base/error.hpp"

#include <utility>

namespace muldi::base {

InputError::InputError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(to_string(diagnostics)), diagnostics_(std::move(diagnostics)) {}

InputError::InputError(std::string message)
    : InputError(std::vector<Diagnostic>{
          {.place = {}, .severity = Severity::error, .path = {}, .message = std::move(message)}}) {}

void contract_broken(const char* condition, const char* file, int line, const char* what) {
  throw ContractError(std::string(file) + ":" + std::to_string(line) + ": " + what + " (expected " + condition + ")");
}

}  // namespace muldi::base
