#pragma once
/// What a run needs from outside beside the scene and the recorder.
#include <functional>
#include <string>

#include "base/phases.hpp"

namespace muldi::pipeline {

struct RunContext {
  std::string command_line = {};
  int threads = 1;
  base::Phases phases = {};
  std::function<bool()> interrupted = {};                            ///< asked before every step
  std::function<void(long done, long all, double t)> progress = {};  ///< called at every recorded node
  std::function<void(const std::string&)> warn = {};                 ///< messages about the numerics
};

}  // namespace muldi::pipeline
