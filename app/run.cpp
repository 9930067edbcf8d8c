#include <filesystem>
#include <optional>

#include "app/exit_code.hpp"
#include "app/interrupt.hpp"
#include "app/progress_bar.hpp"
#include "app/verbs.hpp"
#include "base/log.hpp"
#include "base/text.hpp"
#include "pipeline/run.hpp"
#include "results/hdf5_recorder.hpp"
#include "results/result_file.hpp"
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

/// The checkpoint of the record that the initial state comes from.
std::optional<results::Checkpoint> earlier_state(const scene::Scene& scene, const std::string& scene_path) {
  const scene::InitialFrom& from = scene.initial.from;
  if (from.kind != scene::InitialFrom::Kind::record) return {};
  std::filesystem::path path(from.file);
  if (path.is_relative()) path = std::filesystem::path(scene_path).parent_path() / path;
  const auto stored = results::ResultFile(path.string()).checkpoint();
  if (!stored) {
    throw base::InputError({scene::error_at(from.origin, "the record holds no state of a dynamic run to start from")});
  }
  return stored->checkpoint;
}

void report(const pipeline::Outcome& outcome, const std::string& path) {
  const std::string status = variational::name_of(outcome.status);
  if (outcome.completed()) {
    base::log_info(base::format("completed: {}", path));
  } else if (outcome.status == variational::Status::interrupted) {
    base::log_warning(base::format("interrupted at t = {:.6g}; go on with --resume {}", outcome.time, path));
  } else {
    base::log_error(base::format("{} at t = {:.6g}: {} (what was computed is in {})", status, outcome.time,
                                 outcome.sentence, path));
  }
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
  const std::optional<results::Checkpoint> earlier = earlier_state(*scene, arguments.scene);
  const results::Output output = output_of(arguments);
  results::Hdf5Recorder recorder(output);
  watch_interrupts();
  ProgressBar bar(arguments.progress && base::verbosity() != base::Verbosity::quiet, scene->units.time());
  context.interrupted = interrupt_asked;
  context.progress = [&](long done, long all, double t) { bar.update(done, all, t); };
  context.warn = [&](const std::string& sentence) {
    bar.clear();
    base::log_warning(sentence);
  };
  const pipeline::Outcome outcome = pipeline::run(*scene, *built, recorder, context, earlier);
  bar.clear();
  report(outcome, output.path);
  return exit_code(outcome.status);
}

}  // namespace muldi::app
