#include "pipeline/optimise.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/text.hpp"
#include "pipeline/initial_state.hpp"
#include "pipeline/optimal_guess.hpp"
#include "pipeline/optimal_problem.hpp"
#include "pipeline/optimum_record.hpp"
#include "pipeline/provenance.hpp"
#include "pipeline/trajectory_rows.hpp"

namespace muldi::pipeline {
namespace {

using control::SolveStatus;

variational::Status status_of(SolveStatus status) {
  switch (status) {
    case SolveStatus::optimal:
    case SolveStatus::acceptable:
      return variational::Status::completed;
    case SolveStatus::infeasible:
      return variational::Status::infeasible;
    case SolveStatus::iteration_limit:
      return variational::Status::iteration_limit;
    case SolveStatus::interrupted:
      return variational::Status::interrupted;
    case SolveStatus::failed:
    case SolveStatus::unavailable:
      break;
  }
  return variational::Status::no_convergence;
}

bool is_good(const control::SolveResult& result) { return status_of(result.status) == variational::Status::completed; }

/// Names of the objectives of a stage.
std::string names_of(const std::vector<control::WeightedObjective>& sum) {
  std::vector<std::string> names;
  names.reserve(sum.size());
  for (const control::WeightedObjective& one : sum) {
    names.push_back(std::visit([](const auto& objective) { return std::string(objective.name); }, one.objective));
  }
  return base::joined(names, " + ");
}

/// Whether the stages of `a` led to something better than those of `b`.
bool is_better(const std::vector<StageEnd>& a, const std::vector<StageEnd>& b) {
  if (b.empty()) return true;
  const bool good_a = is_good(a.back().result);
  const bool good_b = is_good(b.back().result);
  if (good_a != good_b) return good_a;
  if (a.size() != b.size()) return a.size() > b.size();
  if (good_a) return a.back().result.objective < b.back().result.objective;
  return a.back().result.infeasibility < b.back().result.infeasibility;
}

Outcome outcome_of(const StageEnd& last) {
  std::string sentence = last.result.sentence;
  if (!is_good(last.result) && !last.result.worst_constraint.empty()) {
    sentence += base::format("; the largest violation is that of {}", last.result.worst_constraint);
  }
  return {.status = status_of(last.result.status), .sentence = sentence, .time = last.result.worst_time};
}

/// All stages from all guesses.
class Stages {
 public:
  Stages(const scene::Scene& scene, const build::BuiltModel& built, const OptimalProblem& problem,
         const OptimiseSetup& setup, RunContext& context)
      : scene_(scene), built_(built), problem_(problem), setup_(setup), context_(context) {}

  /// From all guesses, the first of which is given; the best is left in `result`.
  void solve_all(control::Trajectory first, OptimumRecord& record, Optimised& result) {
    std::vector<StartEnd> starts;
    const int n_starts = n_guesses(scene_);
    bool interrupted = false;
    for (int start = 0; start < n_starts && !interrupted; ++start) {
      control::Trajectory guess = start == 0 ? std::move(first) : make_guess(scene_, built_, problem_.problem, start);
      std::vector<StageEnd> ends = solve(start, std::move(guess), record);
      const StageEnd& last = ends.back();
      if (last.result.status == SolveStatus::unavailable) throw base::EnvironmentError(last.result.sentence);
      starts.push_back({.objective = last.result.objective,
                        .sum_squared_field = last.sum_squared_field,
                        .optimal = is_good(last.result) && ends.size() == problem_.stages.size()});
      interrupted = last.result.status == SolveStatus::interrupted || (context_.interrupted && context_.interrupted());
      if (!is_better(ends, result.stages)) continue;
      result.stages = std::move(ends);
      result.best_start = start;
    }
    result.outcome = outcome_of(result.stages.back());
    if (interrupted) result.outcome.status = variational::Status::interrupted;
    if (n_starts > 1) record.write_starts(starts);
  }

 private:
  /// From one guess; ends at the first stage that fails.
  std::vector<StageEnd> solve(int start, control::Trajectory guess, OptimumRecord& record) {
    std::vector<StageEnd> ends;
    const int n_stages = static_cast<int>(problem_.stages.size());
    for (int i = 0; i < n_stages; ++i) {
      StageEnd end{.begin = {.stage = i,
                             .n_stages = n_stages,
                             .start = start,
                             .n_starts = n_guesses(scene_),
                             .minimises = names_of(problem_.stages[static_cast<std::size_t>(i)])}};
      if (setup_.begins) setup_.begins(end.begin);
      const scene::Stage& said = scene_.optimal_control->stages[static_cast<std::size_t>(i)];
      control::SolveOptions options{.max_iterations = said.max_iterations, .tolerance = said.tolerance};
      options.interrupted = context_.interrupted;
      options.progress = [&](const control::Iterate& iterate) {
        record.write(i, start, iterate);
        if (setup_.iterate) setup_.iterate(iterate);
      };
      end.result = control::solve(problem_.problem, problem_.stages[static_cast<std::size_t>(i)], guess, options);
      end.sum_squared_field = sum_of_squared_fields(scene_, built_, end.result.trajectory);
      if (setup_.ends) setup_.ends(end);
      guess = end.result.trajectory;
      const bool good = is_good(end.result);
      ends.push_back(std::move(end));
      if (!good) break;
    }
    return ends;
  }

  const scene::Scene& scene_;
  const build::BuiltModel& built_;
  const OptimalProblem& problem_;
  const OptimiseSetup& setup_;
  RunContext& context_;
};

}  // namespace

void validate_optimal_control(const scene::Scene& scene, const build::BuiltModel& built,
                              const std::optional<results::Checkpoint>& earlier) {
  variational::State start;
  if (!initial_state(scene, built, earlier, start).completed()) return;
  const OptimalProblem problem = build_optimal_problem(scene, built, start.x);
  const control::Trajectory guess = make_guess(scene, built, problem.problem, 0);
  refuse_faults(scene, control::find_faults(problem.problem, guess));
  if (scene.optimal_control->replay) build_replay(scene);
}

Optimised optimise(const scene::Scene& scene, const build::BuiltModel& built, results::Recorder& recorder,
                   RunContext& context, const OptimiseSetup& setup) {
  Optimised result;
  std::optional<OptimalProblem> problem;
  std::optional<control::Trajectory> guess;
  std::optional<NodeRows> rows;
  std::optional<OptimumRecord> record;
  std::optional<ReplayRun> replay;
  {
    const base::Phases::Scope scope(context.phases, "prepare");
    variational::State start;
    result.outcome = initial_state(scene, built, setup.earlier, start);
    if (result.outcome.completed()) {
      problem.emplace(build_optimal_problem(scene, built, start.x));
      guess = make_guess(scene, built, problem->problem, 0);
      refuse_faults(scene, control::find_faults(problem->problem, *guess));
    }
    rows.emplace(recorder, scene, built, NodeRows::Kind::dynamics,
                 static_cast<std::size_t>(scene.optimal_control->n_steps()) + 1);
    record.emplace(recorder, scene);
    if (scene.optimal_control->replay) replay.emplace(scene, recorder);
    set_provenance(recorder, scene, context);
    recorder.start();
  }
  if (problem) {
    const base::Phases::Scope scope(context.phases, "optimise");
    Stages(scene, built, *problem, setup, context).solve_all(std::move(*guess), *record, result);
    for (const StageEnd& end : result.stages) record->write_end(end.begin.stage, end.result, end.sum_squared_field);
    const control::Trajectory& optimum = result.stages.back().result.trajectory;
    record->write_trajectory(built, optimum);
    TrajectoryRows(built, optimum).write(*rows);
    if (result.outcome.completed()) result.outcome.time = static_cast<double>(optimum.u.size()) * optimum.step;
  }
  if (replay && result.outcome.completed()) {
    const base::Phases::Scope scope(context.phases, "replay");
    const control::Trajectory& optimum = result.stages.back().result.trajectory;
    result.outcome = replay->run(optimum, TrajectoryRows(built, optimum).initial_rates(), context);
    result.replay = replay->deviations();
  }
  set_wall_times(recorder, context.phases);
  recorder.close({.status = variational::name_of(result.outcome.status),
                  .where = result.outcome.sentence,
                  .time = result.outcome.time});
  return result;
}

}  // namespace muldi::pipeline
