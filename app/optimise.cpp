#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <optional>

#include "app/earlier_record.hpp"
#include "app/exit_code.hpp"
#include "app/interrupt.hpp"
#include "app/progress_bar.hpp"
#include "app/run_output.hpp"
#include "app/verbs.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/text.hpp"
#include "pipeline/optimise.hpp"
#include "pipeline/required_size.hpp"
#include "pipeline/summary.hpp"
#include "results/hdf5_recorder.hpp"
#include "scene/read_scene.hpp"

namespace muldi::app {
namespace {

/// The iterates as they come, on a terminal (or with -v).
class IteratesTable {
 public:
  explicit IteratesTable(bool enabled)
      : enabled_(enabled && (isatty(STDERR_FILENO) != 0 || base::verbosity() >= base::Verbosity::verbose)) {}

  void begin(const pipeline::StageBegin& stage) {
    const std::string guess =
        stage.n_starts > 1 ? base::format("guess {} of {}, ", stage.start + 1, stage.n_starts) : std::string();
    base::log_info(base::format("{}stage {} of {}: {}", guess, stage.stage + 1, stage.n_stages, stage.minimises));
    if (enabled_) {
      base::log_plain("  iter     objective   infeasible      dual     barrier      |step|   primal    dual");
    }
  }
  void row(const control::Iterate& it) const {
    if (!enabled_) return;
    base::log_plain(base::format("{:6}{} {:13.6e}  {:10.3e}  {:9.2e}  {:9.2e}  {:9.2e}  {:7.1e}  {:7.1e}", it.iteration,
                                 it.restoration ? "r" : " ", it.objective, it.infeasibility, it.dual_infeasibility,
                                 it.barrier, it.step_size, it.primal_step, it.dual_step));
  }

 private:
  bool enabled_;
};

/// Consecutive numbers as ranges: `0-4, 7`.
std::string ranges_of(const std::vector<int>& numbers) {
  std::vector<std::string> ranges;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t j = i;
    while (j + 1 < numbers.size() && numbers[j + 1] == numbers[j] + 1) ++j;
    ranges.push_back(i == j ? base::format("{}", numbers[i]) : base::format("{}-{}", numbers[i], numbers[j]));
    i = j + 1;
  }
  return base::joined(ranges);
}

std::string stage_text(const pipeline::StageEnd& end, const scene::Scene& scene) {
  const control::SolveResult& result = end.result;
  std::string text = base::format(
      "stage {} of {}, {}: {} after {} iterations, {:.3g} s ({} unknowns, {} constraints; functions {:.0f} "
      "%, Hessians {:.0f} %)\n",
      end.begin.stage + 1, end.begin.n_stages, end.begin.minimises, control::name_of(result.status), result.iterations,
      result.times.total, result.n_variables, result.n_constraints, 100.0 * result.times.functions / result.times.total,
      100.0 * result.times.hessian / result.times.total);
  if (!result.sentence.empty()) text += base::format("  {}\n", result.sentence);
  text += base::format("  objective {:.10g}, infeasibility {:.3g}\n", result.objective, result.infeasibility);
  if (!scene.muscles.empty()) {
    text += base::format("  sum of squared fields {:.10g} (kV/mm)^2\n", end.sum_squared_field);
  }
  if (scene.optimal_control->duration.is_free()) {
    text += base::format("  duration {:.10g} {}\n",
                         result.trajectory.step * static_cast<double>(result.trajectory.u.size()), scene.units.time());
  }
  for (const control::ActiveBound& bound : result.active) {
    text += base::format("  at its {} bound: {}, {}\n", bound.upper ? "upper" : "lower", bound.name,
                         ranges_of(bound.nodes));
  }
  const bool good = result.status == control::SolveStatus::optimal || result.status == control::SolveStatus::acceptable;
  if (!good && !result.worst_constraint.empty()) {
    text += base::format("  largest violation: {} at t = {:.6g} {}, {:.3g}\n", result.worst_constraint,
                         result.worst_time, scene.units.time(), result.worst_violation);
  }
  return text;
}

std::string deviations_text(const pipeline::Deviations& deviations, const scene::Scene& scene) {
  constexpr double degrees = 180.0 / std::numbers::pi;
  std::string text;
  if (deviations.stopped_at) {
    text =
        base::format("the replay stopped at t = {:.6g} {}; up to there\n", *deviations.stopped_at, scene.units.time());
  }
  text += base::format("{:32} {:>14} {:>14}{}\n", "replay less optimum", "largest",
                       deviations.in_horizon ? "where it ends" : "at the end",
                       deviations.beyond ? base::format(" {:>14}", "afterwards") : std::string());
  for (const pipeline::Deviation& one : deviations.all) {
    const double factor = one.is_angle ? degrees : 1.0;
    text += base::format("{:32} {:14.6g} {:14.6g}", one.name, factor * one.largest, factor * one.final);
    if (deviations.beyond) text += base::format(" {:14.6g}", factor * one.after);
    text += base::format(" {}\n", one.is_angle ? "deg" : scene.units.length());
  }
  return text;
}

/// The option by which the next optimisation starts from a result; paths in scenes are relative to the scene.
std::string guess_from(const std::string& path) {
  return base::format("--set 'optimal_control.guess={{from: {}}}'", std::filesystem::absolute(path).string());
}

void report(const pipeline::Optimised& result, const scene::Scene& scene, const std::string& path) {
  std::string text;
  if (!result.stages.empty() && result.stages.front().begin.n_starts > 1) {
    text += base::format("best of {} guesses: {}\n", result.stages.front().begin.n_starts, result.best_start + 1);
  }
  for (const pipeline::StageEnd& end : result.stages) text += stage_text(end, scene);
  if (result.replay) text += deviations_text(*result.replay, scene);
  std::fputs(text.c_str(), stdout);
  if (result.outcome.completed()) {
    base::log_info(base::format("completed: {}", path));
  } else if (result.outcome.status == variational::Status::interrupted) {
    base::log_warning(base::format("interrupted; the best iterate is in {}: go on with {}", path, guess_from(path)));
  } else {
    const bool in_replay = result.replay && result.replay->stopped_at;
    report_failure(result.outcome, in_replay ? pipeline::Task::replay : pipeline::Task::optimal_control, scene,
                   base::format("{} in {}", in_replay ? "the optimum is" : "the best iterate is", path));
  }
}

}  // namespace

int optimise(const RunArguments& arguments) {
  if (!arguments.resume.empty()) {
    throw base::InputError(
        base::format("'{}' cannot be resumed: the solver of an optimisation keeps no state from which it could go on "
                     "as if unbroken; "
                     "start from the last iterate instead, into another file: {}",
                     arguments.resume, guess_from(arguments.resume)));
  }
  pipeline::RunContext context;
  context.command_line = arguments.command_line;
  context.threads = arguments.threads;
  std::optional<scene::Scene> scene;
  std::optional<build::BuiltModel> built;
  {
    const base::Phases::Scope scope(context.phases, "read");
    scene = scene::read_scene(arguments.scene, arguments.overrides);
    print(scene->warnings);
    if (!scene->optimal_control) {
      throw base::InputError({scene::error_at(scene->origin, "nothing to optimise: give `optimal_control:`")});
    }
  }
  {
    const base::Phases::Scope scope(context.phases, "build");
    built = build::build_model(*scene);
    print(built->notes);
  }
  if (base::verbosity() >= base::Verbosity::verbose) {
    base::log_verbose(base::trimmed(pipeline::summary(*scene, *built)));
  }
  const results::Output output = output_of(arguments);
  pipeline::require_size(*scene, *built, output.path);
  pipeline::OptimiseSetup setup{.earlier = earlier_state(*scene)};
  watch_interrupts();
  results::Hdf5Recorder recorder(output);
  const bool shown = arguments.progress && base::verbosity() != base::Verbosity::quiet;
  ProgressBar bar(shown, scene->units.time());
  IteratesTable table(shown);
  setup.begins = [&](const pipeline::StageBegin& stage) { table.begin(stage); };
  setup.iterate = [&](const control::Iterate& iterate) { table.row(iterate); };
  context.interrupted = interrupt_asked;
  context.progress = [&](long done, long all, double t) { bar.update(done, all, t); };
  context.warn = [&](const std::string& sentence) {
    bar.clear();
    base::log_warning(sentence);
  };
  const pipeline::Optimised result = pipeline::optimise(*scene, *built, recorder, context, setup);
  bar.clear();
  report(result, *scene, output.path);
  report_phases(context.phases);
  return exit_code(result.outcome.status);
}

}  // namespace muldi::app
