#include <cmath>
#include <optional>

#include "app/earlier_record.hpp"
#include "app/exit_code.hpp"
#include "app/interrupt.hpp"
#include "app/progress_bar.hpp"
#include "app/run_output.hpp"
#include "app/verbs.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "pipeline/required_size.hpp"
#include "pipeline/run.hpp"
#include "pipeline/summary.hpp"
#include "results/hdf5_recorder.hpp"
#include "results/xdmf.hpp"
#include "scene/read_scene.hpp"

namespace muldi::app {
namespace {

pipeline::Task task_of(const pipeline::Outcome& outcome, const scene::Scene& scene) {
  if (std::isnan(outcome.time)) return pipeline::Task::statics;
  const bool is_explicit = scene.dynamics && scene.dynamics->integrator == scene::Integrator::explicit_scheme;
  return is_explicit ? pipeline::Task::explicit_dynamics : pipeline::Task::dynamics;
}

void report(const pipeline::Outcome& outcome, const scene::Scene& scene, const std::string& path) {
  const std::string at = std::isnan(outcome.time) ? "" : base::format(" at t = {:.6g}", outcome.time);
  if (outcome.completed()) {
    base::log_info(base::format("completed: {}", path));
  } else if (outcome.status == variational::Status::interrupted) {
    base::log_warning(base::format("interrupted{}; go on with --resume {}", at, path));
  } else {
    report_failure(outcome, task_of(outcome, scene), scene, base::format("what was computed is in {}", path));
  }
}

}  // namespace

int run(const RunArguments& arguments) {
  pipeline::RunContext context;
  context.command_line = arguments.command_line;
  context.threads = arguments.threads;
  base::set_threads(arguments.threads);
  std::optional<scene::Scene> scene;
  std::optional<build::BuiltModel> built;
  {
    const base::Phases::Scope scope(context.phases, "read");
    scene = scene::read_scene(arguments.scene, arguments.overrides);
    print(scene->warnings);
    if (!scene->statics && !scene->dynamics) {
      const std::string hint = scene->optimal_control ? "; for `optimal_control:` there is the verb optimise" : "";
      throw base::InputError({scene::error_at(scene->origin, "nothing to run: give `statics:` or `dynamics:`" + hint)});
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
  if (base::verbosity() >= base::Verbosity::debug) base::log_debug(base::trimmed(scene::resolved_text(*scene)));
  const results::Output output = output_of(arguments);
  pipeline::require_size(*scene, *built, output.path);
  if (output.mode == results::Output::Mode::resume && is_complete(*scene, output.path)) {
    base::log_info(base::format("'{}' is complete already: nothing to do{}", output.path,
                                scene->dynamics ? " (a longer dynamics.duration would go on)" : ""));
    return ExitCode::success;
  }
  const std::optional<results::Checkpoint> earlier = earlier_state(*scene);
  watch_interrupts();
  results::Hdf5Recorder recorder(output);
  ProgressBar bar(arguments.progress && base::verbosity() != base::Verbosity::quiet, scene->units.time());
  context.interrupted = interrupt_asked;
  context.progress = [&](long done, long all, double t) { bar.update(done, all, t); };
  context.warn = [&](const std::string& sentence) {
    bar.clear();
    base::log_warning(sentence);
  };
  const pipeline::Outcome outcome = pipeline::run(*scene, *built, recorder, context, earlier);
  bar.clear();
  if (arguments.paraview && outcome.status != variational::Status::write_error) {
    write_side_files(output.path, *scene);
  }
  report(outcome, *scene, output.path);
  report_phases(context.phases);
  return exit_code(outcome.status);
}

}  // namespace muldi::app
