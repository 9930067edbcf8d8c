/// The scene cube_scaling from 8^3 to 64^3 cells: time and memory of ten steps, and how they grow (performance, 7).
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>

#include "base/parallel.hpp"
#include "bench_report.hpp"
#include "scene_runs.hpp"

namespace {

using namespace muldi;

struct Measured {
  double build = 0.0;      ///< s, to the state at t = 0
  double steps = 0.0;      ///< s, ten steps with their records
  double processor = 0.0;  ///< s of all cores, on a busy machine the more telling number
  double peak = 0.0;       ///< GB
  double iterations = 0.0;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Measured run_here(int n, const std::string& electric) {
  base::set_threads(2);
  Measured measured;
  auto start = std::chrono::steady_clock::now();
  const std::string cells = std::to_string(n);
  const bench::ReadyScene ready(scene::read_scene(
      bench::scene_path("cube_scaling"), {"solids.cube.mesh.box.cells=[" + cells + ", " + cells + ", " + cells + "]",
                                          "materials.polymer.electric=" + electric}));
  measured.build = seconds_since(start);
  start = std::chrono::steady_clock::now();
  const variational::LoopStatistics statistics = ready.step("auto");
  measured.steps = seconds_since(start);
  measured.iterations = static_cast<double>(statistics.iterations);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  measured.processor = static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
  measured.peak = 1024e-9 * static_cast<double>(usage.ru_maxrss);
  return measured;
}

/// In a process of its own, for its peak of memory.
Measured run_apart(int n, const std::string& electric) {
  std::array<int, 2> ends{};
  MULDI_EXPECT(pipe(ends.data()) == 0, "a pipe");
  const pid_t child = fork();
  if (child == 0) {
    const Measured measured = run_here(n, electric);
    const bool written = write(ends[1], &measured, sizeof measured) == static_cast<ssize_t>(sizeof measured);
    _exit(written ? 0 : 1);
  }
  Measured measured;
  const bool read_all = read(ends[0], &measured, sizeof measured) == static_cast<ssize_t>(sizeof measured);
  int status = 0;
  waitpid(child, &status, 0);
  close(ends[0]);
  close(ends[1]);
  MULDI_EXPECT(read_all && status == 0, "the scene runs through");
  return measured;
}

/// Slope of log y over log of the cells, by least squares.
double exponent(const std::map<int, double>& y) {
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (const auto& [n, value] : y) {
    const double x = 3.0 * std::log(static_cast<double>(n));
    sx += x;
    sy += std::log(value);
    sxx += x * x;
    sxy += x * std::log(value);
  }
  const auto count = static_cast<double>(y.size());
  return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

}  // namespace

/// Arguments: the largest number of cells a side, 64 without.
int main(int argc, char** argv) {
  const int largest = argc > 1 ? std::atoi(argv[1]) : 64;
  bench::BenchReport report("cube_scaling");
  const double none = std::nan("");
  const std::array<std::pair<const char*, const char*>, 2> laws = {
      {{"legacy law", "{model: vu, c1: 5.0e-8, c2: 1.0e-9}"},
       {"ideal dielectric", "{model: ideal_dielectric, relative_permittivity: 3.7}"}}};
  for (const auto& [law, electric] : laws) {
    const bool legacy = &law == &laws[0].first;
    std::map<int, double> time, memory;
    for (int n = 8; n <= largest; n *= 2) {
      const Measured measured = run_apart(n, electric);
      const std::string name = std::string(law) + ", " + std::to_string(n) + "^3, ";
      const double bound = n == 32 && legacy ? 6.0 : n == 64 ? (legacy ? 45.0 : 120.0) : none;
      report.add({name + "start", measured.build, "s"});
      report.add({name + "ten steps", measured.steps, "s", bound});
      report.add({name + "processor time of both", measured.processor, "s"});
      report.add({name + "peak memory", measured.peak, "GB", n == 64 ? 4.0 : none});
      report.add({name + "Newton iterations", measured.iterations, "1"});
      time[n] = measured.processor;
      memory[n] = measured.peak;
    }
    if (time.size() < 2) continue;
    report.add({std::string(law) + ", exponent of processor time", exponent(time), "1", 1.1});
    report.add({std::string(law) + ", exponent of memory", exponent(memory), "1", 1.1});
  }
  report.print();
}
