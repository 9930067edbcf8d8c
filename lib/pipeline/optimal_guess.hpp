#pragma once
/// Where the first stage of an optimal control problem starts.
#include "build/built_model.hpp"
#include "control/problem.hpp"
#include "scene/scene.hpp"

namespace muldi::pipeline {

/// How many guesses the scene asks for: one, or several random ones.
int n_guesses(const scene::Scene& scene);

/// Guess number `start` of the scene, from 0. InputError, located at the guess, for a record that cannot be read or is
/// of another system.
control::Trajectory make_guess(const scene::Scene& scene, const build::BuiltModel& built,
                               const control::Problem& problem, int start);

}  // namespace muldi::pipeline
