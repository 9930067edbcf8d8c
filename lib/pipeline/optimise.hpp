#pragma once
/// The `optimise` pipeline: the stages of `optimal_control:`, then its replay, into a recorder.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "build/built_model.hpp"
#include "control/solve.hpp"
#include "pipeline/outcome.hpp"
#include "pipeline/replay.hpp"
#include "pipeline/run_context.hpp"
#include "results/recorder.hpp"

namespace muldi::pipeline {

/// A stage that is about to be solved.
struct StageBegin {
  int stage = 0;  ///< from 0
  int n_stages = 1;
  int start = 0;  ///< which guess, from 0
  int n_starts = 1;
  std::string minimises = {};  ///< names of the objectives
};

/// How a stage ended.
struct StageEnd {
  StageBegin begin = {};
  control::SolveResult result = {};
  double sum_squared_field = 0.0;  ///< over intervals and muscles, (kV/mm)^2
};

/// What optimise() takes beside the scene, and what it says meanwhile; any may be empty.
struct OptimiseSetup {
  std::optional<results::Checkpoint> earlier = {};  ///< of the record that `initial.from` names
  std::function<void(const StageBegin&)> begins = {};
  std::function<void(const control::Iterate&)> iterate = {};
  std::function<void(const StageEnd&)> ends = {};
};

struct Optimised {
  Outcome outcome = {};
  std::vector<StageEnd> stages = {};  ///< of the best guess
  int best_start = 0;
  std::optional<Deviations> replay = {};
};

/// Solves the stages from every guess, each stage from the one before, keeps the best, and replays its controls. The
/// recorder is started and closed here; on failure and interrupts it holds the best iterate.
/// InputError for problems that can be refused before the solve; EnvironmentError if the solver's library is missing or
/// the results cannot be written.
Optimised optimise(const scene::Scene& scene, const build::BuiltModel& built, results::Recorder& recorder,
                   RunContext& context, const OptimiseSetup& setup);

/// What can be said of the problem without solving it. InputError as of optimise().
void validate_optimal_control(const scene::Scene& scene, const build::BuiltModel& built,
                              const std::optional<results::Checkpoint>& earlier);

}  // namespace muldi::pipeline
