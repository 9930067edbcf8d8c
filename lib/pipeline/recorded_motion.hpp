#pragma once
/// Motions in result files as guesses of an optimal control problem.
#include <string>

#include "build/built_model.hpp"
#include "control/problem.hpp"

namespace muldi::pipeline {

/// The motion in a result file, as it is recorded: of `optimise` its optimum, finished or not, in its own steps; of
/// `run` the joint coordinates and controls, interpolated onto the steps of the problem. Where a run is shorter than
/// the horizon, its last pose is held. InputError for files that cannot be read, hold no motion, or are of another
/// system.
control::Trajectory recorded_motion(const scene::Scene& scene, const build::BuiltModel& built,
                                    const control::Problem& problem, const std::string& path);

}  // namespace muldi::pipeline
