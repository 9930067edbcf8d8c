#include <cmath>
#include <filesystem>
#include <optional>

#include "app/drawing.hpp"
#include "app/earlier_record.hpp"
#include "app/exit_code.hpp"
#include "app/interrupt.hpp"
#include "app/progress_bar.hpp"
#include "app/verbs.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/text.hpp"
#include "pipeline/run.hpp"
#include "pipeline/summary.hpp"
#include "results/hdf5_recorder.hpp"
#include "results/xdmf.hpp"
#include "scene/read_scene.hpp"

namespace muldi::app {
namespace {

void print(const std::vector<base::Diagnostic>& diagnostics) {
  for (const base::Diagnostic& diagnostic : diagnostics) base::log_plain(base::to_string(diagnostic));
}

results::Output output_of(const RunArguments& arguments) {
  results::Output output;
  if (!arguments.resume.empty()) {
    output.path = arguments.resume;
    output.mode = results::Output::Mode::resume;
    return output;
  }
  output.path =
      arguments.output.empty() ? std::filesystem::path(arguments.scene).stem().string() + ".h5" : arguments.output;
  output.mode = arguments.force ? results::Output::Mode::overwrite : results::Output::Mode::create;
  return output;
}

void report(const pipeline::Outcome& outcome, const std::string& path) {
  const std::string status = variational::name_of(outcome.status);
  const std::string at = std::isnan(outcome.time) ? "" : base::format(" at t = {:.6g}", outcome.time);
  if (outcome.completed()) {
    base::log_info(base::format("completed: {}", path));
  } else if (outcome.status == variational::Status::interrupted) {
    base::log_warning(base::format("interrupted{}; go on with --resume {}", at, path));
  } else {
    base::log_error(base::format("{}{}: {} (what was computed is in {})", status, at, outcome.sentence, path));
  }
}

/// The result is what counts: without room for the side files it is complete all the same.
void write_side_files(const std::string& path, const results::Drawing& drawing) {
  try {
    for (const std::string& side : results::write_xdmf(path, drawing)) {
      base::log_verbose(base::format("for ParaView: {}", side));
    }
  } catch (const base::EnvironmentError& error) {
    base::log_warning(base::format("no side file for ParaView: {}", error.what()));
  }
}

void report_phases(const base::Phases& phases) {
  std::vector<std::string> parts;
  for (const base::Phase& phase : phases.all()) parts.push_back(base::format("{} {:.3g} s", phase.name, phase.seconds));
  base::log_verbose("wall time: " + base::joined(parts, ", "));
}

}  // namespace

int run(const RunArguments& arguments) {
  pipeline::RunContext context;
  context.command_line = arguments.command_line;
  context.threads = arguments.threads;
  std::optional<scene::Scene> scene;
  std::optional<build::BuiltModel> built;
  {
    const base::Phases::Scope scope(context.phases, "read");
    scene = scene::read_scene(arguments.scene, arguments.overrides);
    print(scene->warnings);
    if (!scene->statics && !scene->dynamics) {
      throw base::InputError({scene::error_at(scene->origin, "nothing to run: give `statics:` or `dynamics:`")});
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
    write_side_files(output.path, drawing_of(*scene));
  }
  report(outcome, output.path);
  report_phases(context.phases);
  return exit_code(outcome.status);
}

}  // namespace muldi::app
