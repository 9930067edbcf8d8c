#include "app/earlier_record.hpp"

#include <algorithm>
#include <sstream>

#include "base/error.hpp"
#include "base/text.hpp"
#include "pipeline/checkpoint.hpp"
#include "results/live_file.hpp"
#include "results/result_file.hpp"
#include "scene/read_scene.hpp"

namespace muldi::app {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw base::InputError("'" + path + "' cannot be resumed: " + why);
}

std::string trimmed(const std::string& line) {
  const std::size_t first = line.find_first_not_of(' ');
  return first == std::string::npos ? "nothing" : "'" + line.substr(first) + "'";
}

/// The first line in which two texts differ, as a sentence.
std::string difference(const std::string& recorded, const std::string& now) {
  std::istringstream left(recorded), right(now);
  std::string a, b;
  while (a == b && (left || right)) {
    if (!std::getline(left, a)) a.clear();
    if (!std::getline(right, b)) b.clear();
  }
  return base::format("the record has {}, the scene {}", trimmed(a), trimmed(b));
}

/// All but the duration must be as it was, or the two parts would not make one run.
void require_same_scene(scene::Scene scene, const std::string& path, const std::string& recorded_text) {
  const scene::Scene recorded = scene::read_scene_text(recorded_text, path);
  if (scene.dynamics && recorded.dynamics) scene.dynamics->duration = recorded.dynamics->duration;
  const std::string text = scene::resolved_text(scene);
  if (text != recorded_text) refuse(path, "it is of another scene: " + difference(recorded_text, text));
}

}  // namespace

std::optional<results::Checkpoint> earlier_state(const scene::Scene& scene) {
  const scene::InitialFrom& from = scene.initial.from;
  if (from.kind != scene::InitialFrom::Kind::record) return {};
  try {
    const auto stored = results::ResultFile(scene::path_of_file(scene, from.file)).checkpoint();
    if (stored && pipeline::in_dynamics(stored->checkpoint)) return stored->checkpoint;
  } catch (const base::InputError& error) {
    throw base::InputError({scene::error_at(from.origin, error.diagnostics().front().message)});
  }
  throw base::InputError({scene::error_at(from.origin, "the record holds no state of a motion to start from")});
}

bool is_complete(const scene::Scene& scene, const std::string& path) {
  results::remove_stale_mark(path);
  const results::ResultFile record(path);
  const auto stored = record.checkpoint();
  const std::string text = record.text("scene");
  if (!stored || text.empty()) refuse(path, "it is no record of a run");
  require_same_scene(scene, path, text);
  const bool completed = record.text("status") == "completed";
  if (!scene.dynamics) return completed;
  const long done = pipeline::steps_of(stored->checkpoint);
  const long wanted = scene.dynamics->n_steps();
  if (done > wanted) {
    refuse(path, base::format("it has reached t = {:.6g} already, beyond dynamics.duration: {:.6g}",
                              static_cast<double>(done) * scene.dynamics->step, scene.dynamics->duration));
  }
  return completed && done == wanted;
}

}  // namespace muldi::app
