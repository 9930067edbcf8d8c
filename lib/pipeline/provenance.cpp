#include "pipeline/provenance.hpp"

#include <ctime>

#include "base/build_info.hpp"
#include "scene/read_scene.hpp"

namespace muldi::pipeline {

void set_provenance(results::Recorder& recorder, const scene::Scene& scene, const RunContext& context) {
  const base::BuildInfo& build = base::build_info();
  const auto text = [&](const char* name, std::string value) { recorder.set_attribute("", name, std::move(value)); };
  text("muldi_version", std::string(build.version));
  recorder.set_attribute("", "format", std::int64_t{scene::format_version});
  text("title", scene.title);
  text("scene", scene::resolved_text(scene));
  text("units", units_text(scene));
  text("command_line", context.command_line);
  text("git_hash", std::string(build.commit));
  text("compiler", std::string(build.compiler) + " " + std::string(build.flags));
  std::string libraries;
  for (const base::LibraryVersion& library : build.libraries) {
    if (!libraries.empty()) libraries += ", ";
    libraries += std::string(library.name) + " " + std::string(library.version);
  }
  text("libraries", libraries);
  recorder.set_attribute("", "threads", std::int64_t{context.threads});
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char created[32];
  std::strftime(created, sizeof created, "%Y-%m-%dT%H:%M:%SZ", &utc);
  text("created", created);
}

std::string units_text(const scene::Scene& scene) {
  return scene.units.length() + ", " + scene.units.mass() + ", " + scene.units.time() + ", " + scene.units.current();
}

void set_wall_times(results::Recorder& recorder, const base::Phases& phases) {
  for (const base::Phase& phase : phases.all()) {
    recorder.set_attribute("", "wall_time." + phase.name, phase.seconds);
  }
}

}  // namespace muldi::pipeline
