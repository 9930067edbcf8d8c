/// What the formulations I to IV cost on switch and joint (thesis 5.5.3): processor time in one run, relative to I, and
/// whether III and IV give the same numbers. Published: II costs 2.6 times I; the bound is 1.3.
#include <algorithm>
#include <ctime>
#include <limits>

#include "base/text.hpp"
#include "bench/bench_report.hpp"
#include "bench/scene_runs.hpp"
#include "results/memory_recorder.hpp"

namespace {

using namespace muldi;

constexpr int repeats = 5;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Cost {
  double statics = 0.0;   // s of processor time
  double dynamics = 0.0;  // the same
  std::vector<double> energy;
};

/// One run of a scene without files.
double seconds_of(const std::string& name, const std::vector<std::string>& overrides, std::vector<double>& energy) {
  const scene::Scene scene = scene::read_scene(bench::scene_path(name), overrides);
  const build::BuiltModel built = build::build_model(scene);
  results::MemoryRecorder recorder;
  pipeline::RunContext context;
  const double start = processor_seconds();
  const pipeline::Outcome outcome = pipeline::run(scene, built, recorder, context, {});
  const double seconds = processor_seconds() - start;
  MULDI_EXPECT(outcome.completed(), "the benchmark scene runs through");
  const auto total = recorder.reals("energy/total");
  energy.assign(total.begin(), total.end());
  return seconds;
}

Cost cost_of(const std::string& name, const std::string& duration) {
  Cost cost;
  std::vector<double> unused;
  cost.statics = cost.dynamics = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const double statics = seconds_of(name, {"dynamics.duration=1 ms"}, unused);
    const double whole = seconds_of(name, {"dynamics.duration=" + duration}, cost.energy);
    cost.statics = std::min(cost.statics, statics);
    cost.dynamics = std::min(cost.dynamics, whole - statics);
  }
  return cost;
}

}  // namespace

int main() {
  bench::BenchReport report("formulations");
  for (const auto& [system, duration] : {std::pair("dea_switch", "150 ms"), std::pair("dea_joint", "500 ms")}) {
    const auto cost = [&](const char* number) { return cost_of(base::format("{}_{}", system, number), duration); };
    const Cost first = cost("I"), second = cost("II"), third = cost("III"), fourth = cost("IV");
    report.add({base::format("{}, I, {} of dynamics", system, duration), first.dynamics, "s"});
    const auto add = [&](const char* number, const Cost& one, double bound) {
      report.add({base::format("{}, {} over I, dynamics", system, number), one.dynamics / first.dynamics, "1", bound});
      report.add({base::format("{}, {} over I, statics", system, number), one.statics / first.statics, "1"});
    };
    add("II", second, 1.3);
    add("III", third, std::nan(""));
    add("IV", fourth, std::nan(""));
    report.add({base::format("{}, energies of III and IV differ (0: equal bits)", system),
                third.energy == fourth.energy ? 0.0 : 1.0, "1", 0.0});
  }
  report.print();
}
