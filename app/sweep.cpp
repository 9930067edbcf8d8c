#include "pipeline/study/sweep.hpp"

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "app/earlier_record.hpp"
#include "app/exit_code.hpp"
#include "app/interrupt.hpp"
#include "app/progress_bar.hpp"
#include "app/study.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/special_file.hpp"
#include "base/text.hpp"

namespace muldi::app {
namespace {

namespace fs = std::filesystem;

/// Reads `k/n` with 1 <= k <= n.
void read_shard(const std::string& text, pipeline::SweepSetup& setup) {
  const char* const end = text.data() + text.size();
  auto [slash, fault] = std::from_chars(text.data(), end, setup.shard);
  bool good = fault == std::errc() && slash != end && *slash == '/';
  if (good) {
    const auto [stop, second] = std::from_chars(slash + 1, end, setup.n_shards);
    good = second == std::errc() && stop == end && setup.shard >= 1 && setup.shard <= setup.n_shards;
  }
  if (!good) throw base::InputError("--shard: needs k/n with 1 <= k <= n, got " + base::in_quotes(text));
}

std::string in_shell_quotes(const std::string& word) {
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// The script of a Slurm array job: each task runs a shard, the last one to end writes the table.
std::string slurm_script(const StudyArguments& arguments, const std::string& table) {
  const std::string name = fs::path(arguments.study).stem().string();
  // A name without a folder is found on the path of the node, too.
  const bool placed = arguments.program.find('/') != std::string::npos;
  const std::string program = placed ? fs::absolute(arguments.program).string() : arguments.program;
  std::string command = base::format("exec {} sweep {} -o {}", in_shell_quotes(program),
                                     in_shell_quotes(fs::absolute(arguments.study).string()),
                                     in_shell_quotes(fs::absolute(table).string()));
  for (const std::string& override : arguments.overrides) command += " --set " + in_shell_quotes(override);
  command += " --shard \"$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT\" --no-progress";
  return base::format(
      "#!/bin/bash\n"
      "# Array job of the sweep {0}: sbatch this file. Tasks that were broken off are submitted again as they are; "
      "the\n"
      "# task that finishes the last point writes the table.\n"
      "#SBATCH --job-name={0}\n"
      "#SBATCH --array=1-{1}\n"
      "#SBATCH --ntasks=1\n"
      "#SBATCH --cpus-per-task=1\n"
      "#SBATCH --output={0}.%a.log\n"
      "{2}\n",
      name, arguments.jobs, command);
}

int write_script(const StudyArguments& arguments, const std::string& table) {
  if (fs::exists(arguments.slurm) && !arguments.force) {
    throw base::InputError(base::format("'{}' exists; give --force to overwrite it", arguments.slurm));
  }
  base::refuse_unwritable_output(arguments.slurm);
  std::ofstream out(arguments.slurm, std::ios::binary | std::ios::trunc);
  out << slurm_script(arguments, table) << std::flush;
  if (!out) throw base::EnvironmentError("cannot write '" + arguments.slurm + "'");
  std::error_code none;
  fs::permissions(arguments.slurm, fs::perms::owner_exec, fs::perm_options::add, none);
  base::log_info(base::format("written: {}; submit it with sbatch", arguments.slurm));
  return ExitCode::success;
}

int report(const pipeline::SweepEnd& end, const std::string& table) {
  if (end.interrupted) {
    base::log_warning(
        base::format("interrupted with {} of {} points to do; the same command goes on", end.n_missing, end.n_points));
    return ExitCode::interrupted;
  }
  const std::string failed =
      end.n_failed == 0 ? "" : base::format(", of which {} failed (status in the table)", end.n_failed);
  if (end.written) {
    const std::string csv = fs::path(table).replace_extension(".csv").string();
    base::log_info(
        base::format("{} of {} points{}: {}, {}", end.n_points - end.n_missing, end.n_points, failed, table, csv));
  } else {
    base::log_info(base::format("{} of {} points{}; {} to do{}", end.n_points - end.n_missing, end.n_points, failed,
                                end.n_missing, end.n_killed > 0 ? "" : " in other shards"));
  }
  const bool incomplete = (end.written && end.n_missing > 0) || end.n_killed > 0;
  return end.n_failed > 0 || incomplete ? ExitCode::numerics_failed : ExitCode::success;
}

}  // namespace

int sweep(const StudyArguments& arguments) {
  pipeline::SweepSetup setup;
  setup.table = arguments.output.empty() ? fs::path(arguments.study).stem().string() + ".h5" : arguments.output;
  if (fs::path(setup.table).extension() != ".h5") {
    throw base::InputError("-o: needs a file that ends in .h5, got " + base::in_quotes(setup.table));
  }
  base::refuse_unwritable_output(setup.table);
  setup.jobs = arguments.jobs;
  setup.force = arguments.force;
  setup.merge_only = arguments.merge;
  if (!arguments.shard.empty()) read_shard(arguments.shard, setup);
  const scene::SweepStudy study = scene::read_sweep_study(arguments.study);
  const scene::SceneText scene = scene::scene_of_study(study.origin, study.scene, study.set, arguments.overrides);
  if (!arguments.slurm.empty()) return write_script(arguments, setup.table);
  watch_interrupts();
  ProgressBar bar(arguments.progress && base::verbosity() != base::Verbosity::quiet, "points");
  setup.earlier = earlier_state;
  setup.interrupted = interrupt_asked;
  setup.progress = [&](std::size_t done, std::size_t all) {
    bar.update(static_cast<long>(done), static_cast<long>(all), static_cast<double>(done));
  };
  setup.failed = [&](std::size_t point, const std::string& overrides, const std::string& why) {
    bar.clear();
    base::log_warning(base::format("point {} ({}): {}", point, overrides, why));
  };
  const pipeline::SweepEnd end = pipeline::sweep(study, scene, setup);
  bar.clear();
  return report(end, setup.table);
}

}  // namespace muldi::app
