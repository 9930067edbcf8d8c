#pragma once
/// Scenes run inside a benchmark: stepping alone, and the whole way from YAML to HDF5.
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "build/built_model.hpp"
#include "pipeline/initial_state.hpp"
#include "pipeline/run.hpp"
#include "results/hdf5_recorder.hpp"
#include "scene/read_scene.hpp"
#include "variational/time_loop.hpp"

namespace muldi::bench {

inline std::string scene_path(const std::string& name) {
  return std::string(MULDI_SOURCE_DIR) + "/scenes/" + name + ".yaml";
}

/// A scene, its model and its state at t = 0.
struct ReadyScene {
  scene::Scene scene;
  build::BuiltModel built;
  variational::State state;

  explicit ReadyScene(scene::Scene read) : scene(std::move(read)), built(build::build_model(scene)) {
    const pipeline::Outcome outcome = pipeline::initial_state(scene, built, {}, state);
    MULDI_EXPECT(outcome.completed(), "the benchmark scene has an initial state");
  }

  /// Steps without records; returns the statistics.
  variational::LoopStatistics step(const std::string& linear) const {
    variational::LoopOptions options{.dt = scene.dynamics->step, .steps = scene.dynamics->n_steps()};
    options.record_every = options.steps;
    options.step.linear = linear;
    variational::TimeLoop loop(*built.model, options);
    variational::State at = state;
    variational::Ledger ledger;
    variational::StepReport last;
    const variational::LoopResult result = loop.run(at, ledger, last, {});
    MULDI_EXPECT(result.status == variational::Status::completed, "the benchmark scene runs through");
    return result.statistics;
  }
};

/// Reads, builds, runs and writes a scene, as the program does.
inline void run_to_file(const std::string& path, const std::vector<std::string>& overrides) {
  const scene::Scene scene = scene::read_scene(path, overrides);
  const build::BuiltModel built = build::build_model(scene);
  const std::string output = (std::filesystem::temp_directory_path() / "muldi_bench.h5").string();
  results::Hdf5Recorder recorder({.path = output, .mode = results::Output::Mode::overwrite});
  pipeline::RunContext context;
  const pipeline::Outcome outcome = pipeline::run(scene, built, recorder, context, {});
  MULDI_EXPECT(outcome.completed(), "the benchmark scene runs through");
  std::filesystem::remove(output);
}

}  // namespace muldi::bench
