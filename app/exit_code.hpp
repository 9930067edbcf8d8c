#pragma once
/// Exit codes of the program (scene format, section 1).
#include "pipeline/outcome.hpp"

namespace muldi::app {

enum ExitCode : int {
  success = 0,
  differs = 1,
  wrong_input = 2,
  numerics_failed = 3,
  environment_failed = 4,
  interrupted = 130,
};

constexpr int exit_code(variational::Status status) {
  switch (status) {
    case variational::Status::completed:
      return ExitCode::success;
    case variational::Status::interrupted:
      return ExitCode::interrupted;
    case variational::Status::write_error:
      return ExitCode::environment_failed;
    default:
      return ExitCode::numerics_failed;
  }
}

}  // namespace muldi::app
