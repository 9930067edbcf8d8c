#include <cstdio>

#include "app/earlier_record.hpp"
#include "app/exit_code.hpp"
#include "app/verbs.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "pipeline/checkpoint.hpp"
#include "pipeline/initial_state.hpp"
#include "pipeline/optimise.hpp"
#include "pipeline/required_size.hpp"
#include "pipeline/summary.hpp"
#include "scene/read_scene.hpp"

namespace muldi::app {

int validate(const std::vector<std::string>& scenes, const std::vector<std::string>& overrides) {
  int code = ExitCode::success;
  for (const std::string& path : scenes) {
    try {
      const scene::Scene scene = scene::read_scene(path, overrides);
      const build::BuiltModel built = build::build_model(scene);
      for (const auto* list : {&scene.warnings, &built.notes}) {
        for (const base::Diagnostic& diagnostic : *list) base::log_plain(base::to_string(diagnostic));
      }
      pipeline::require_size(scene, built);
      const std::optional<results::Checkpoint> earlier = earlier_state(scene);
      if (earlier) pipeline::state_of(*earlier, scene, *built.model);
      pipeline::initial_rates(scene, built, pipeline::initial_coordinates(scene, built));
      if (scene.optimal_control) pipeline::validate_optimal_control(scene, built, earlier);
      std::fputs((path + ": " + pipeline::summary(scene, built)).c_str(), stdout);
    } catch (const base::InputError& error) {
      base::log_plain(error.what());
      code = ExitCode::wrong_input;
    }
  }
  return code;
}

}  // namespace muldi::app
