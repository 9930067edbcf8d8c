/// From the start of the process to the first step, and to the end of a run of one step.
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "bench/bench_report.hpp"
#include "bench/scene_runs.hpp"
#include "results/hdf5_file.hpp"

namespace {

void run_program(const std::vector<std::string>& arguments) {
  const std::string program = std::string(MULDI_BINARY_DIR) + "/app/muldi-sim";
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t silent;
  posix_spawn_file_actions_init(&silent);
  posix_spawn_file_actions_addopen(&silent, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  if (posix_spawn(&child, program.c_str(), &silent, nullptr, argv.data(), environ) != 0) std::abort();
  posix_spawn_file_actions_destroy(&silent);
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) std::abort();
}

/// Wall time of the phases before the first step, as the run recorded them (s).
double seconds_of_preparation(const std::string& output) {
  const auto file = muldi::results::hdf5::File::open(output, muldi::results::hdf5::Access::read);
  double sum = 0.0;
  for (const std::string phase : {"read", "build", "prepare"}) {
    sum += std::get<double>(file.attribute({}, "wall_time." + phase).value());
  }
  return sum;
}

}  // namespace

int main() {
  using namespace muldi;
  bench::BenchReport report("start_up");
  const std::string output = (std::filesystem::temp_directory_path() / "muldi_start.h5").string();
  const double launch = bench::median_seconds(31, [&] { run_program({"--version"}); });
  report.add({"process start and end, nothing done", 1e3 * launch, "ms"});
  for (const std::string name : {"revolute_joint_lumped", "elephant_trunk_lumped"}) {
    std::vector<double> before;
    const double seconds = bench::median_seconds(31, [&] {
      run_program({"--quiet", "run", bench::scene_path(name), "--force", "-o", output, "--set", "dynamics.duration=1",
                   "--set", "statics.steps=1"});
      before.push_back(seconds_of_preparation(output));
    });
    std::nth_element(before.begin(), before.begin() + 15, before.end());
    report.add({name + ", process start to first step", 1e3 * (launch + before[15]), "ms", 10.0});
    report.add({name + ", process start to end of one step, file included", 1e3 * seconds, "ms"});
  }
  std::filesystem::remove(output);
  report.print();
}
