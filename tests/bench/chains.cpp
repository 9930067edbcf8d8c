/// Chains of revolute bodies: time and memory over the number of bodies, tree elimination against the dense joint
/// space.
#include <sys/resource.h>

#include <cmath>
#include <sstream>

#include "bench/bench_report.hpp"
#include "bench/scene_runs.hpp"

namespace {

using namespace muldi;

constexpr int n_steps = 20;

/// A hanging chain with a torsion spring in every joint, released from the horizontal.
std::string chain_text(int n) {
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
         << ", at: left}, axis: [0, " << i % 2 << ", 1], stiffness: 100}\n";
  }
  text << "dynamics: {duration: " << n_steps << ", step: 1}\n";
  return text.str();
}

double resident_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace

int main() {
  bench::BenchReport report("chains");
  const std::vector<int> sizes{50, 100, 200, 500, 1000, 2000};
  std::vector<double> step_ms;
  std::vector<double> memory;
  for (const int n : sizes) {
    const bench::ReadyScene chain(scene::read_scene_text(chain_text(n), "chain.yaml"));
    step_ms.push_back(1e3 / n_steps * bench::median_seconds(5, [&] { chain.step("tree"); }));
    memory.push_back(resident_megabytes());
    report.add({"chain of " + std::to_string(n) + ", one step", step_ms.back(), "ms", n == 200 ? 5.0 : std::nan("")});
    if (n != 200) continue;
    const double dense = 1e3 / n_steps * bench::median_seconds(1, [&] { chain.step("dense"); });
    report.add({"chain of 200, dense joint space over tree", dense / step_ms.back(), "1"});
  }
  report.add({"time exponent, 200 to 2000 bodies", std::log(step_ms.back() / step_ms[2]) / std::log(10.0), "1", 1.1});
  report.add({"memory of 2000 bodies over 1000", (memory.back() - memory[0]) / (memory[4] - memory[0]), "1", 2.3});
  report.add({"memory of 2000 bodies, whole process", memory.back(), "MiB"});
  report.print();
}
