#pragma once
/// What /optimum of a result file holds: iterates while they come, then how each stage ended, and the trajectory.
#include <vector>

#include "build/built_model.hpp"
#include "control/solve.hpp"
#include "results/recorder.hpp"
#include "scene/scene.hpp"

namespace muldi::pipeline {

/// How one guess ended, for the table of guesses.
struct StartEnd {
  double objective = 0.0;
  double sum_squared_field = 0.0;
  bool optimal = false;
};

/// Declares the groups of all stages; nothing is allocated by iterates.
class OptimumRecord {
 public:
  OptimumRecord(results::Recorder& recorder, const scene::Scene& scene);

  /// One row of the iterates of a stage; `start`: which guess, from 0.
  void write(int stage, int start, const control::Iterate& iterate);
  /// How a stage ended; after the start of the recorder, once a stage.
  void write_end(int stage, const control::SolveResult& result, double sum_squared_field);
  /// The trajectory that later optimisations may start from.
  void write_trajectory(const build::BuiltModel& built, const control::Trajectory& trajectory);
  /// One row a guess, where there are several.
  void write_starts(const std::vector<StartEnd>& starts);

 private:
  struct Channels {
    results::Series series;
    results::Channel start, restoration, objective, infeasibility, dual_infeasibility, barrier, step_size, primal_step,
        dual_step, regularisation;
  };
  void write_scalar(const std::string& path, double value, const std::string& unit, const std::string& doc);

  results::Recorder& recorder_;
  const scene::Scene& scene_;
  std::vector<Channels> stages_;
};

}  // namespace muldi::pipeline
