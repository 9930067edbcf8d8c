#include "pipeline/required_size.hpp"

#include <filesystem>

#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/text.hpp"

namespace muldi::pipeline {

double memory_bytes(const scene::Scene& scene, const build::BuiltModel& built) {
  const double tangent = static_cast<double>(built.model->pattern->n_values());
  const double states = 40.0 * static_cast<double>(built.model->n_q() + built.model->n_y() + built.manifold->n_v());
  double dense = 0.0;
  if (scene.statics) dense = 4.0 * built.manifold->n_v() * built.manifold->n_v();
  return 8.0 * (2.0 * tangent + states + dense);
}

double result_bytes(const scene::Scene& scene, const build::BuiltModel& built) {
  double row = 32.0;
  for (const model::Observable& observable : built.model->observables) row += static_cast<double>(observable.size());
  row += 4.0 * static_cast<double>(built.model->parts().size());
  double rows = 0.0;
  if (scene.statics) rows += scene.statics->steps + 1.0;
  if (scene.dynamics) rows += static_cast<double>(scene.dynamics->n_steps()) / scene.record.every + 1.0;
  double fields = 0.0;
  for (const model::FieldHistory& history : built.model->histories) {
    double one = 0.0;
    for (const auto& field : history.fields) one += static_cast<double>(field.observable.size());
    fields += one * (rows / history.every + 1.0);
  }
  return 8.0 * (row * rows + fields);
}

void require_size(const scene::Scene& scene, const build::BuiltModel& built, const std::string& output) {
  base::require_memory(memory_bytes(scene, built),
                       base::format("a system of {} bodies{}", scene.bodies.size(),
                                    scene.statics ? ", whose statics solve with a dense matrix," : ""),
                       "take fewer bodies" + std::string(scene.statics ? ", or dynamics alone" : ""));
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
