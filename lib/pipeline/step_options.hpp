#pragma once
/// What the scene's `solver:` and the built model say about every step of a run or a replay.
#include "build/built_model.hpp"
#include "variational/stepper.hpp"

namespace muldi::pipeline {

inline variational::StepOptions step_options(const scene::Scene& scene, const build::BuiltModel& built) {
  variational::StepOptions options;
  options.tolerance = scene.solver.tolerance;
  options.max_iterations = scene.solver.max_iterations;
  options.linear = built.linear;
  options.substructures = built.solid_linear;
  return options;
}

}  // namespace muldi::pipeline
