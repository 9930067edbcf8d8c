#pragma once
/// Scene -> optimal control problem.
#include <vector>

#include "build/built_model.hpp"
#include "control/problem.hpp"
#include "pipeline/outcome.hpp"
#include "variational/state.hpp"

namespace muldi::pipeline {

/// The problem of a scene and what its stages minimise. The model and the scene must outlive it.
struct OptimalProblem {
  control::Problem problem;
  std::vector<std::vector<control::WeightedObjective>> stages;
};

/// Builds the problem of `optimal_control:`. `start`: the state in which `run` would start, the pose `scene`.
/// InputError with all that does not fit the model (loop-closing joints, balls), located in the scene.
OptimalProblem build_optimal_problem(const scene::Scene& scene, const build::BuiltModel& built,
                                     const Eigen::VectorXd& start);

/// Faults of the problem as InputError at the entries they are about; nothing if there are none.
void refuse_faults(const scene::Scene& scene, const std::vector<control::Fault>& faults);

/// Controls of all intervals from the functions of the scene, at the middles (n_steps, n_controls).
std::vector<std::vector<double>> scheduled_controls(const control::Problem& problem, double step);

/// Sum over intervals and muscles of the squared field, in (kV/mm)^2.
double sum_of_squared_fields(const scene::Scene& scene, const build::BuiltModel& built,
                             const control::Trajectory& trajectory);

}  // namespace muldi::pipeline
