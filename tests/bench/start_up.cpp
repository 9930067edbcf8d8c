/// From the start of the process to the end of a run of one step: everything but stepping.
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "bench/bench_report.hpp"
#include "bench/scene_runs.hpp"

namespace {

void run_program(const std::vector<std::string>& arguments) {
  const std::string program = std::string(MULDI_BINARY_DIR) + "/app/muldi-sim";
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  pid_t child = 0;
  if (posix_spawn(&child, program.c_str(), nullptr, nullptr, argv.data(), environ) != 0) std::abort();
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) std::abort();
}

}  // namespace

int main() {
  using namespace muldi;
  bench::BenchReport report("start_up");
  const std::string output = (std::filesystem::temp_directory_path() / "muldi_start.h5").string();
  for (const std::string name : {"revolute_joint_lumped", "elephant_trunk_lumped"}) {
    const double seconds = bench::median_seconds(31, [&] {
      run_program({"--quiet", "run", bench::scene_path(name), "--force", "-o", output, "--set", "dynamics.duration=1",
                   "--set", "statics.steps=1"});
    });
    report.add({name + ", process start to end of one step, file included", 1e3 * seconds, "ms", 10.0});
  }
  const double empty = bench::median_seconds(31, [&] {
    run_program({"--quiet", "validate", bench::scene_path("pendulum")});
  });
  report.add({"validate pendulum, whole process", 1e3 * empty, "ms"});
  std::filesystem::remove(output);
  report.print();
}
