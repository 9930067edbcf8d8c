#include "pipeline/study/sweep.hpp"

#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <new>

#include "base/build_info.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "build/built_model.hpp"
#include "pipeline/node_rows.hpp"
#include "pipeline/optimise.hpp"
#include "pipeline/required_size.hpp"
#include "pipeline/run.hpp"
#include "pipeline/study/output_expression.hpp"
#include "pipeline/study/sweep_table.hpp"
#include "pipeline/study/workers.hpp"
#include "scene/read_scene.hpp"

namespace muldi::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr const char* environment_failed = "environment_failed";

class SweepRun {
 public:
  SweepRun(const scene::SweepStudy& study, const scene::SceneText& scene, const SweepSetup& setup)
      : study_(study), scene_(scene), setup_(setup), plan_(plan_sweep(study, scene)) {
    read_outputs();
    stem_ = fs::path(setup.table).replace_extension(".journal").string();
    std::vector<std::string> texts{std::string(base::build_info().version),
                                   study.verb == scene::StudyVerb::run ? "run" : "optimise",
                                   scene::resolved_text(scene.read({}))};
    for (const OutputExpression& output : outputs_) texts.push_back(output.text);
    for (const DesignPoint& point : plan_.points) {
      texts.insert(texts.end(), point.overrides.begin(), point.overrides.end());
    }
    fingerprint_ = fingerprint_of(texts);
  }

  SweepEnd run() {
    const bool begun = was_begun(stem_, fingerprint_);
    if (setup_.merge_only && !begun) {
      throw base::InputError(
          base::format("nothing to merge: no part of this sweep has begun beside '{}'", setup_.table));
    }
    if (!setup_.force && !begun && fs::exists(setup_.table)) {
      throw base::InputError(
          base::format("'{}' exists and is of no such sweep; give --force to overwrite it, or -o FILE", setup_.table));
    }
    SweepEnd end{.n_points = plan_.points.size()};
    if (!setup_.merge_only) run_missing(end);
    const std::vector<FinishedPoint> rows =
        all_rows(plan_, outputs_.size(), finished_points(stem_, fingerprint_, outputs_.size()));
    for (const FinishedPoint& row : rows) {
      if (row.status == "missing") {
        ++end.n_missing;
      } else if (row.status != "completed") {
        ++end.n_failed;
      }
    }
    if (!end.interrupted && (end.n_missing == 0 || setup_.merge_only)) {
      write_table({.plan = plan_,
                   .names = names_,
                   .units = units_,
                   .rows = rows,
                   .study = fs::path(study_.file).filename().string()},
                  setup_.table);
      end.written = true;
    }
    return end;
  }

 private:
  /// Parses the outputs and looks them up in what the first point declares.
  void read_outputs() {
    std::vector<base::Diagnostic> errors;
    results::MemoryRecorder recorder;
    const scene::Scene first = scene_.read(plan_.points.front().overrides);
    const bool is_run = study_.verb == scene::StudyVerb::run;
    if (is_run && !first.statics && !first.dynamics) {
      errors.push_back(scene::error_at(study_.origin, "nothing to run: the scene has neither statics nor dynamics"));
    }
    if (!is_run && !first.optimal_control) {
      errors.push_back(scene::error_at(study_.origin, "nothing to optimise: the scene has no optimal_control"));
    }
    const build::BuiltModel built = build::build_model(first);
    require_size_in_memory(first, built);
    std::optional<NodeRows> statics;
    std::optional<NodeRows> dynamics;
    if (is_run && first.statics) statics.emplace(recorder, first, built, NodeRows::Kind::statics, 1);
    if (is_run && first.dynamics) dynamics.emplace(recorder, first, built, NodeRows::Kind::dynamics, 1);
    for (const scene::SweepOutput& output : study_.outputs.items) {
      std::string error;
      names_.push_back(output.name);
      units_.emplace_back();
      outputs_.push_back(parse_output(output.expression, error));
      if (error.empty() && is_run) error = why_no_output(outputs_.back(), recorder.declared(), units_.back());
      if (!error.empty()) errors.push_back(scene::error_at(output.origin, error));
    }
    if (!errors.empty()) throw base::InputError(std::move(errors));
  }

  std::string journal() const {
    return setup_.n_shards == 1 ? stem_ : base::format("{}.{}-of-{}", stem_, setup_.shard, setup_.n_shards);
  }

  /// Removes the journals of shards; a shard leaves those of others alone.
  void forget() const {
    if (setup_.n_shards > 1) return;
    std::error_code none;
    const fs::path folder = fs::path(stem_).has_parent_path() ? fs::path(stem_).parent_path() : fs::path(".");
    const std::string name = fs::path(stem_).filename().string();
    std::vector<fs::path> old;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
      if (entry.path().filename().string().starts_with(name + ".")) old.push_back(entry.path());
    }
    for (const fs::path& path : old) fs::remove(path, none);
  }

  void run_missing(SweepEnd& end) {
    if (setup_.force) forget();
    Journal journal(this->journal(), fingerprint_, setup_.force);  // begun anew, it has no points
    std::vector<bool> is_done(plan_.points.size(), false);
    for (const FinishedPoint& point : finished_points(stem_, fingerprint_, outputs_.size())) {
      if (point.point < is_done.size()) is_done[point.point] = true;
    }
    std::vector<std::size_t> tasks;
    std::size_t n_own = 0;
    for (std::size_t i = 0; i < is_done.size(); ++i) {
      if (static_cast<int>(i % static_cast<std::size_t>(setup_.n_shards)) != setup_.shard - 1) continue;
      ++n_own;
      if (!is_done[i]) tasks.push_back(i);
    }
    std::size_t done = n_own - tasks.size();
    WorkerCalls calls;
    calls.work = [this](std::size_t task) { return to_line(run_point(task)); };
    calls.interrupted = setup_.interrupted;
    calls.done = [&](std::size_t task, const std::string& answer, int signal) {
      if (signal == SIGKILL) {
        ++end.n_killed;
        if (setup_.failed) {
          setup_.failed(task, base::joined(plan_.points[task].overrides),
                        "killed from outside, for want of memory perhaps: it is tried again the next time");
        }
        return;
      }
      FinishedPoint point;
      if (!from_line(answer, outputs_.size(), point)) {
        point = failed(task, "crashed", signal > 0 ? base::format("ended by signal {}", signal) : "ended early");
      }
      if (point.status == environment_failed) throw base::EnvironmentError(point.sentence);
      journal.append(point);
      ++end.n_run;
      if (point.status != "completed" && setup_.failed) {
        setup_.failed(task, base::joined(plan_.points[task].overrides), point.status + ": " + point.sentence);
      }
      if (setup_.progress) setup_.progress(++done, n_own);
    };
    end.interrupted = !run_in_processes(tasks, setup_.jobs, calls);
  }

  FinishedPoint failed(std::size_t task, std::string status, std::string sentence) const {
    return {.point = task,
            .status = std::move(status),
            .outputs = std::vector<double>(outputs_.size(), std::numeric_limits<double>::quiet_NaN()),
            .sentence = std::move(sentence)};
  }

  /// One point, in a process of its own.
  FinishedPoint run_point(std::size_t task) const {
    try {
      results::MemoryRecorder recorder;
      const Outcome outcome = run_scene(scene_.read(plan_.points[task].overrides), recorder);
      if (!outcome.completed()) return failed(task, variational::name_of(outcome.status), outcome.sentence);
      FinishedPoint point{.point = task, .status = "completed"};
      for (const OutputExpression& output : outputs_) point.outputs.push_back(value_of(output, recorder));
      return point;
    } catch (const base::InputError& error) {
      return failed(task, "wrong_input", error.what());
    } catch (const base::EnvironmentError& error) {
      return failed(task, environment_failed, error.what());
    } catch (const std::bad_alloc&) {
      return failed(task, "out_of_memory", "not enough memory");
    }
  }

  Outcome run_scene(const scene::Scene& scene, results::MemoryRecorder& recorder) const {
    const build::BuiltModel built = build::build_model(scene);
    require_size_in_memory(scene, built);
    RunContext context;
    const std::optional<results::Checkpoint> earlier = setup_.earlier ? setup_.earlier(scene) : std::nullopt;
    if (study_.verb == scene::StudyVerb::run) return pipeline::run(scene, built, recorder, context, earlier);
    OptimiseSetup setup;
    setup.earlier = earlier;
    return pipeline::optimise(scene, built, recorder, context, setup).outcome;
  }

  const scene::SweepStudy& study_;
  const scene::SceneText& scene_;
  const SweepSetup& setup_;
  SweepPlan plan_;
  std::vector<std::string> names_;
  std::vector<std::string> units_;
  std::vector<OutputExpression> outputs_;
  std::string stem_;
  std::uint64_t fingerprint_ = 0;
};

}  // namespace

SweepEnd sweep(const scene::SweepStudy& study, const scene::SceneText& scene, const SweepSetup& setup) {
  return SweepRun(study, scene, setup).run();
}

}  // namespace muldi::pipeline
