#pragma once
/// What the end of a run means to its user, and what may help.
#include <string_view>

#include "variational/state.hpp"

namespace muldi::pipeline {

/// What ended.
enum class Task { statics, dynamics, explicit_dynamics, optimal_control, replay };

struct Advice {
  std::string_view meaning = {};  ///< what happened, in a sentence without full stop; empty if nothing needs it
  std::string_view remedy = {};   ///< what to try
};

/// In people's words; empty for ends that are no failure.
Advice advice_on(variational::Status status, Task task);

}  // namespace muldi::pipeline
