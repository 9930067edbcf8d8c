/// A sweep of 200 lumped joints, 1 s of motion at 1 ms each, from start to table.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "bench/bench_report.hpp"
#include "bench/scene_runs.hpp"

int main() {
  using namespace muldi;
  namespace fs = std::filesystem;
  bench::BenchReport report("sweep");
  const fs::path folder = fs::temp_directory_path() / "muldi_sweep";
  fs::create_directories(folder);
  std::ofstream(folder / "study.yaml") << "sweep: 1\nscene: " << bench::scene_path("revolute_joint_lumped")
                                       << "\nvary:\n"
                                          "  controls.agonist.field: {linspace: [0, 40 kV/mm, 20]}\n"
                                          "  materials.silicone.viscous.viscosity: {logspace: [5, 50, 10]}\n"
                                          "outputs: {angle: \"joints.hinge.coordinate[-1]\"}\n";
  const std::string command = std::string(MULDI_BINARY_DIR) + "/app/muldi-sim --quiet sweep " +
                              (folder / "study.yaml").string() + " -o " + (folder / "t.h5").string() +
                              " --force --jobs ";
  for (const std::string jobs : {"1", "2"}) {
    const double seconds = bench::median_seconds(3, [&] {
      fs::remove(folder / "t.csv");
      if (std::system((command + jobs).c_str()) != 0 || !fs::exists(folder / "t.csv")) std::abort();
    });
    report.add({"200 joints, --jobs " + jobs, seconds, "s", jobs == "2" ? 20.0 : std::nan("")});
  }
  fs::remove_all(folder);
  report.print();
  return 0;
}
