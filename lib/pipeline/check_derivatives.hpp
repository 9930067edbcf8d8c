#pragma once
/// `check --derivatives`: every derivative that a scene uses, against differences of what it is the derivative of.
#include <string>
#include <vector>

#include "build/built_model.hpp"

namespace muldi::pipeline {

/// One derivative.
struct CheckedDerivative {
  std::string of;      ///< what is differentiated, e.g. "muscles/upper and 1 more: force by configuration"
  double error = 0.0;  ///< relative, against extrapolated differences
  double slope =
      0.0;  ///< of the Taylor remainder, infinite where it is round-off; NaN where only differences are taken
  double expected = 0.0;  ///< slope of a correct derivative
  bool passed = false;
};

/// Checks all terms and substructures of the model near the state in which `run` would start, and the optimal control
/// problem where the scene has one. InputError for a scene whose start is impossible.
std::vector<CheckedDerivative> check_derivatives(const scene::Scene& scene, const build::BuiltModel& built);

}  // namespace muldi::pipeline
