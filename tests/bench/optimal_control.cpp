/// Optimal control: the published problems from scene to optimum, and where the time goes.
///
/// Times to compare with, on two cores: an independent minimal-coordinate program with Ipopt 3.11 and MUMPS takes 0.03
/// s for the revolute effort problem and 2.8 s for the trunk effort problem from a cold guess.
#include <cmath>

#include "bench/bench_report.hpp"
#include "bench/scene_runs.hpp"
#include "pipeline/optimise.hpp"
#include "results/memory_recorder.hpp"

namespace {

using namespace muldi;

/// Solves the stages of a scene without its replay.
pipeline::Optimised solve(const scene::Scene& scene, const build::BuiltModel& built) {
  results::MemoryRecorder recorder;
  pipeline::RunContext context;
  pipeline::Optimised found = pipeline::optimise(scene, built, recorder, context, {});
  MULDI_EXPECT(found.outcome.completed(), "the benchmark problem is solved");
  return found;
}

struct Case {
  std::string name;
  std::string scene;
  std::vector<std::string> overrides;
  int repetitions = 1;
  double limit = std::nan("");  // s
};

void measure(bench::BenchReport& report, const Case& one) {
  scene::Scene scene = scene::read_scene(bench::scene_path(one.scene), one.overrides);
  scene.optimal_control->replay.reset();
  const build::BuiltModel built = build::build_model(scene);
  pipeline::Optimised found;
  const double all = bench::median_seconds(one.repetitions, [&] { found = solve(scene, built); });
  report.add({one.name + ", in all", all, "s", one.limit});
  control::SolveTimes times;
  int iterations = 0;
  for (const pipeline::StageEnd& stage : found.stages) {
    times.transcription += stage.result.times.transcription;
    times.functions += stage.result.times.functions;
    times.hessian += stage.result.times.hessian;
    times.total += stage.result.times.total;
    iterations += stage.result.iterations;
  }
  const double evaluations = times.functions + times.hessian;
  report.add({one.name + ", iterations", static_cast<double>(iterations), "1"});
  report.add({one.name + ", values and first derivatives", times.functions, "s"});
  report.add({one.name + ", Hessians", times.hessian, "s"});
  report.add({one.name + ", linear algebra and solver", times.total - evaluations - times.transcription, "s"});
  report.add({one.name + ", all evaluations", evaluations, "s", 0.25 * one.limit});
}

}  // namespace

int main() {
  bench::BenchReport report("optimal_control");
  measure(report, {"revolute joint, 200 ms", "revolute_joint_optimal", {}, 5, 0.1});
  measure(report, {"revolute joint, 70 ms",
                   "revolute_joint_optimal",
                   {"optimal_control.duration=70 ms", "optimal_control.step=5 ms"},
                   5,
                   0.1});
  measure(report, {"trunk, effort from rest",
                   "elephant_trunk_optimal",
                   {"optimal_control.stages=[{minimise: {effort: {scale: 1.0e-14}}}]"},
                   1,
                   2.0});
  measure(report, {"trunk, the published path", "elephant_trunk_optimal", {}, 1});
  report.print();
}
