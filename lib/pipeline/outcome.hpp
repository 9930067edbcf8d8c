#pragma once
/// How a pipeline ended.
#include <string>

#include "variational/state.hpp"

namespace muldi::pipeline {

struct Outcome {
  variational::Status status = variational::Status::completed;
  std::string sentence = {};  ///< what happened and what may help; empty if completed
  double time = 0.0;          ///< simulated time reached; NaN in statics

  bool completed() const { return status == variational::Status::completed; }
};

}  // namespace muldi::pipeline
