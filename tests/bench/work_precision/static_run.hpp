#pragma once
/// Equilibria of a scene, the whole pipeline without a file.
#include <string>
#include <vector>

#include "bench/scene_runs.hpp"
#include "bench/work_precision/work_report.hpp"
#include "results/memory_recorder.hpp"

namespace muldi::bench {

struct StaticEnd {
  double value = std::nan("");  ///< last of the channel; NaN where the run failed
  double seconds = 0.0;
};

/// The last value of a channel of the statics; the time is that of building and solving.
inline StaticEnd static_end(const scene::Scene& scene, const std::string& channel, double budget) {
  StaticEnd end;
  end.seconds = least_seconds(budget, [&] {
    const build::BuiltModel built = build::build_model(scene);
    results::MemoryRecorder recorder;
    pipeline::RunContext context;
    const pipeline::Outcome outcome = pipeline::run(scene, built, recorder, context, {});
    end.value = outcome.completed() ? recorder.reals("statics/" + channel).back() : std::nan("");
  });
  return end;
}

}  // namespace muldi::bench
