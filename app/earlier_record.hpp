#pragma once
/// Records of earlier runs: the one that a scene starts from, and the one that a run goes on with.
#include <optional>
#include <string>

#include "results/layout.hpp"
#include "scene/scene.hpp"

namespace muldi::app {

/// The checkpoint of the record that `initial.from` names; nothing if it names none.
/// InputError, located at `initial.from`, if the record cannot be read or holds no state of a motion.
std::optional<results::Checkpoint> earlier_state(const scene::Scene& scene);

/// Whether the record has everything that the scene asks for. The scene must be the recorded one, except for
/// `dynamics.duration`, which may grow.
/// InputError for another scene, a shorter duration, or a file that is no record.
bool is_complete(const scene::Scene& scene, const std::string& path);

}  // namespace muldi::app
