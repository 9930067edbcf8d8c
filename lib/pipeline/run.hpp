#pragma once
/// The `run` pipeline: the scene's statics, then its dynamics, into a recorder.
#include <optional>

#include "build/built_model.hpp"
#include "pipeline/outcome.hpp"
#include "pipeline/run_context.hpp"
#include "results/recorder.hpp"

namespace muldi::pipeline {

/// Runs everything that the scene asks for. The recorder is started and closed here, with the status of the outcome in
/// it whatever happens. A recorder with a resume point goes on there. `earlier`: the checkpoint of the record that
/// `initial.from` names, if it names one.
/// InputError for initial conditions that contradict each other (before the recorder is started); EnvironmentError if
/// the results cannot be written.
Outcome run(const scene::Scene& scene, const build::BuiltModel& built, results::Recorder& recorder, RunContext& context,
            const std::optional<results::Checkpoint>& earlier);

}  // namespace muldi::pipeline
