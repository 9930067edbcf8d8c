/// Chains of revolute bodies: time and memory over the number of bodies, tree elimination against the dense joint
/// space.
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

#include "bench/bench_report.hpp"
#include "bench/scene_runs.hpp"

namespace {

using namespace muldi;

constexpr int n_steps = 20;

/// A hanging chain, released from the horizontal; with a torsion spring in every joint but the first.
std::string chain_text(int n, bool with_springs) {
  std::ostringstream text;
  text << "muldi: 1\ngravity: [0, -9.81e-3, 0]\nbodies:\n";
  for (int i = 0; i < n; ++i) {
    text << "  b" << i << ": {mass: 40, inertia: [1e4, 3e4, 3e4], position: [" << 46 + 92 * i
         << ", 0, 0], points: {left: [-46, 0, 0], right: [46, 0, 0]}}\n";
  }
  text << "joints:\n  j0: {type: revolute, from: {body: ground, at: [0, 0, 0]}, to: {body: b0, at: left}, axis: [0, 0, "
          "1]}\n";
  for (int i = 1; i < n; ++i) {
    text << "  j" << i << ": {type: revolute, from: {body: b" << i - 1 << ", at: right}, to: {body: b" << i
         << ", at: left}, axis: [0, " << i % 2 << ", 1]" << (with_springs ? ", stiffness: 100}\n" : "}\n");
  }
  text << "dynamics: {duration: " << n_steps << ", step: 1}\n";
  return text.str();
}

bench::ReadyScene ready_chain(int n, bool with_springs) {
  return bench::ReadyScene(scene::read_scene_text(chain_text(n, with_springs), "chain.yaml"));
}

struct Stepping {
  double step_ms = 0.0;     ///< one step
  double iterations = 0.0;  ///< Newton iterations a step
  double iteration_us() const { return 1e3 * step_ms / iterations; }
};

/// Steps of a stepper that is warm: neither its construction nor first touches of its memory count. The same steps are
/// taken `repeats` times, and of each step the fastest counts, since another process can only slow it down.
Stepping stepping(const bench::ReadyScene& chain, const std::string& linear, int repeats) {
  variational::Stepper stepper(*chain.built.model, chain.scene.dynamics->step, {.linear = linear});
  std::array<double, n_steps> best{};
  best.fill(std::numeric_limits<double>::infinity());
  int iterations = 0;
  for (int repeat = 0; repeat <= repeats; ++repeat) {
    variational::State at = chain.state;
    iterations = 0;
    for (double& fastest : best) {
      const auto start = std::chrono::steady_clock::now();
      const variational::StepReport report = stepper.advance(at, {});
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      MULDI_EXPECT(report.status == variational::Status::running, "the chain moves on");
      iterations += report.iterations;
      if (repeat > 0) fastest = std::min(fastest, seconds.count());
    }
  }
  return {.step_ms = 1e3 / n_steps * std::accumulate(best.begin(), best.end(), 0.0),
          .iterations = static_cast<double>(iterations) / n_steps};
}

double exponent(double small, double large, double ratio_of_sizes) {
  return std::log(large / small) / std::log(ratio_of_sizes);
}

/// Adds the figures of the chains with or without springs.
void add_times(bench::BenchReport& report, bool with_springs) {
  const std::string kind = with_springs ? "" : " without springs";
  std::vector<Stepping> of_size;
  for (const int n : {50, 200, 500, 1000, 2000}) {
    of_size.push_back(stepping(ready_chain(n, with_springs), "tree", 10 + 4000 / n));
    const Stepping& now = of_size.back();
    const std::string name = "chain of " + std::to_string(n) + kind;
    report.add({name + ", one step", now.step_ms, "ms", with_springs && n == 200 ? 5.0 : std::nan("")});
    report.add({name + ", one Newton iteration and body", now.iteration_us() / n, "us"});
  }
  report.add({"time exponent, 200 to 2000 bodies" + kind, exponent(of_size[1].step_ms, of_size.back().step_ms, 10.0),
              "1", 1.1});
}

double resident_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Peak memory grows only: from small chains to large ones.
void add_memory(bench::BenchReport& report) {
  std::vector<double> memory;
  for (const int n : {50, 1000, 2000}) {
    ready_chain(n, true).step("tree");
    memory.push_back(resident_megabytes());
  }
  report.add({"memory of 2000 bodies over 1000", (memory[2] - memory[0]) / (memory[1] - memory[0]), "1", 2.3});
  report.add({"memory of 2000 bodies, whole process", memory[2], "MiB"});
}

}  // namespace

int main() {
  bench::BenchReport report("chains");
  add_memory(report);
  for (const bool with_springs : {true, false}) add_times(report, with_springs);
  const bench::ReadyScene chain = ready_chain(200, true);
  report.add({"chain of 200, dense joint space over tree",
              stepping(chain, "dense", 2).step_ms / stepping(chain, "tree", 20).step_ms, "1"});
  report.print();
}
