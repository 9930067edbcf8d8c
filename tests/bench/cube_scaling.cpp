/// The scene cube_scaling from 8^3 to 64^3 cells: time and memory of ten steps, and how they grow (performance, 7).
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
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

/// Microseconds a cell of residual, tangent and scatter on one core.
double assembly_here(int n) {
  const std::string cells = std::to_string(n);
  const bench::ReadyScene ready(scene::read_scene(
      bench::scene_path("cube_scaling"), {"solids.cube.mesh.box.cells=[" + cells + ", " + cells + ", " + cells + "]"}));
  const fem::Solid& solid = *ready.built.solids.front();
  const fem::ElementSet& elements = solid.elements();
  const math::SymmetricBlockPattern pattern(elements.n_nodes(), 4, elements.cells());
  math::SymmetricBlockMatrix matrix(pattern);
  const std::vector<std::int32_t> slots = elements.slots_in(pattern);
  const Eigen::VectorXd x = elements.reference();
  const Eigen::VectorXd v = 1e-3 * x;
  const Eigen::VectorXd phi = solid.potentials(ready.state.y);
  Eigen::VectorXd force = 0.0 * x;
  Eigen::VectorXd charge = 0.0 * phi;
  Eigen::VectorXd momentum = force;
  const fem::ElementFields at{.x = x.data(), .v = v.data(), .phi = phi.data()};
  const double seconds = bench::median_seconds(3, [&] {
    matrix.set_zero();
    elements.tangent(at, {.mass = 1e4, .stiffness = 2.5e-5, .rate = 0.5, .x_phi = 5e-5, .phi_phi = 1e-4}, {}, slots,
                     matrix);
    elements.forces(at, {.force = force.data(), .charge = charge.data(), .momentum = momentum.data()});
  });
  return 1e6 * seconds / elements.n_cells();
}

/// The peer on the same machine, right after ours; nothing where it has not been built.
void compare_with_peer(bench::BenchReport& report, int n) {
  const std::string peer = std::string(MULDI_BINARY_DIR) + "/bench/peer_dealii";
  if (access(peer.c_str(), X_OK) != 0) return;
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 0);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 0);
  const double assembly = assembly_here(n);
  const Measured ours = run_apart(n, "{model: vu, c1: 5.0e-8, c2: 1.0e-9}");
  FILE* output = popen((peer + " " + std::to_string(n) + " 2").c_str(), "r");
  MULDI_EXPECT(output != nullptr, "the peer runs");
  double its_assembly = 0.0, its_steps = 0.0;
  const int n_read = std::fscanf(output, "%lf %lf", &its_assembly, &its_steps);
  pclose(output);
  MULDI_EXPECT(n_read == 2, "the peer's figures");
  const std::string name = "deal.II 9.4, GMRES + SSOR + ML, " + std::to_string(n) + "^3, ";
  report.add({"assembly a cell and core", assembly, "us", 3.0, 2.0});
  report.add({name + "assembly a cell and core", its_assembly, "us"});
  report.add({name + "ten steps", its_steps, "s"});
  report.add({"assembly, ours over the peer's", assembly / its_assembly, "1", 1.0 / 6.0, 1.0 / 10.0});
  report.add({"ten steps, ours over the peer's", ours.steps / its_steps, "1", 1.0 / 6.0, 1.0 / 12.0});
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
      const double aim = n == 32 && legacy ? 3.0 : n == 64 ? (legacy ? 20.0 : 45.0) : none;
      report.add({name + "start", measured.build, "s"});
      report.add({name + "ten steps", measured.steps, "s", bound, aim});
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
  compare_with_peer(report, std::min(largest, 32));
  report.print();
}
