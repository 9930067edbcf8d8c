#pragma once
/// Attributes that say what made a result file.
#include "pipeline/run_context.hpp"
#include "results/recorder.hpp"
#include "scene/scene.hpp"

namespace muldi::pipeline {

/// Version, commit, compiler, libraries, units, resolved scene, time of creation, command line, threads.
void set_provenance(results::Recorder& recorder, const scene::Scene& scene, const RunContext& context);

/// The units of a scene as the attribute names them: length, mass, time, current.
std::string units_text(const scene::Scene& scene);

/// Wall time of each phase, as attributes wall_time.<phase> in seconds.
void set_wall_times(results::Recorder& recorder, const base::Phases& phases);

}  // namespace muldi::pipeline
