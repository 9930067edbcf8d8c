#include "pipeline/required_size.hpp"

#include <filesystem>

#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/text.hpp"

namespace muldi::pipeline {

namespace {

double steps_of(const scene::OptimalControl& problem) {
  return problem.steps ? *problem.steps : problem.duration.max / problem.step.value_or(problem.duration.max);
}

/// Of the matrix of Newton's method of an optimisation: each unknown of a step meets those of its step and of both
/// neighbours, in the second derivatives and in the constraints.
double optimiser_bytes(const scene::Scene& scene, const build::BuiltModel& built) {
  const double block = static_cast<double>(built.manifold->n_v() + built.manifold->n_c()) +
                       static_cast<double>(scene.optimal_control->controls.size());
  constexpr double entry = 8.0 + 2.0 * 4.0;  // a value, its row and column
  constexpr double copies = 4.0;             // ours, the optimiser's, and factors of twice the size at the least
  return copies * entry * steps_of(*scene.optimal_control) * 2.0 * 3.0 * block * block;
}

/// What the messages call the task that takes most.
std::string task_of(const scene::Scene& scene) {
  if (scene.optimal_control)
    return base::format(" over {:.3g} steps of its optimal control", steps_of(*scene.optimal_control));
  return scene.statics ? ", whose statics solve with a dense matrix," : "";
}

std::string mend_of(const scene::Scene& scene) {
  if (scene.optimal_control) return "take fewer bodies, or a longer optimal_control.step";
  return scene.statics ? "take fewer bodies, or dynamics alone" : "take fewer bodies";
}

}  // namespace

double memory_bytes(const scene::Scene& scene, const build::BuiltModel& built) {
  const double tangent = static_cast<double>(built.model->pattern->n_values());
  const double states = 40.0 * static_cast<double>(built.model->n_q() + built.model->n_y() + built.manifold->n_v());
  double dense = 0.0;
  if (scene.statics) dense = 4.0 * built.manifold->n_v() * built.manifold->n_v();
  const double optimiser = scene.optimal_control ? optimiser_bytes(scene, built) : 0.0;
  return 8.0 * (2.0 * tangent + states + dense) + optimiser;
}

double result_bytes(const scene::Scene& scene, const build::BuiltModel& built) {
  double row = 32.0;
  for (const model::Observable& observable : built.model->observables) row += static_cast<double>(observable.size());
  row += 4.0 * static_cast<double>(built.model->parts().size());
  double rows = 0.0;
  if (scene.statics) rows += scene.statics->steps + 1.0;
  if (scene.optimal_control) rows += steps_of(*scene.optimal_control) + 1.0;
  if (scene.dynamics) rows += static_cast<double>(scene.dynamics->n_steps()) / scene.record.every + 1.0;
  double fields = 0.0;
  for (const model::FieldHistory& history : built.model->histories) {
    double one = 0.0;
    for (const auto& field : history.fields) one += static_cast<double>(field.observable.size());
    fields += one * (rows / history.every + 1.0);
  }
  return 8.0 * (row * rows + fields);
}

namespace {

void require_memory_of(const scene::Scene& scene, const build::BuiltModel& built) {
  base::require_memory(memory_bytes(scene, built),
                       base::format("a system of {} {}{}", scene.bodies.size(),
                                    scene.bodies.size() == 1 ? "body" : "bodies", task_of(scene)),
                       mend_of(scene));
}

}  // namespace

void require_size_in_memory(const scene::Scene& scene, const build::BuiltModel& built) {
  const double results = result_bytes(scene, built);
  if (memory_bytes(scene, built) >= results) {
    require_memory_of(scene, built);
    return;
  }
  base::require_memory(results + memory_bytes(scene, built), "a motion with its results in memory",
                       "record fewer rows (record.every) or quantities (record.quantities), or take a longer step or a "
                       "shorter duration");
}

void require_size(const scene::Scene& scene, const build::BuiltModel& built, const std::string& output) {
  require_memory_of(scene, built);
  const std::filesystem::path folder = std::filesystem::path(output).parent_path();
  std::error_code unknown;
  const std::filesystem::space_info disk = std::filesystem::space(folder.empty() ? "." : folder, unknown);
  const double results = result_bytes(scene, built);
  // File systems without a size (/proc) say 0.
  if (unknown || disk.capacity == 0 || results <= static_cast<double>(disk.capacity)) return;
  constexpr double gibi = 1024.0 * 1024.0 * 1024.0;
  throw base::InputError(
      base::format("the results take {:.3g} GiB, more than the {:.3g} GiB of the whole disk: record fewer rows "
                   "(record.every) or quantities (record.quantities), or take a longer step or a shorter duration",
                   results / gibi, static_cast<double>(disk.capacity) / gibi));
}

}  // namespace muldi::pipeline
