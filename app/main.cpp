/// The command line: options, verbs, exit codes. The only file that knows CLI11.
#include <CLI/CLI.hpp>
#include <exception>

#include "app/exit_code.hpp"
#include "app/verbs.hpp"
#include "base/error.hpp"
#include "base/log.hpp"

namespace {

using namespace muldi;

struct CommandLine {
  app::RunArguments run;
  std::vector<std::string> scenes;
  std::string first;
  std::string second;
  results::CompareOptions compare;
  bool quiet = false;
  bool no_progress = false;
  int verbose = 0;
};

void add_scene_options(CLI::App& verb, CommandLine& line) {
  verb.add_option("--set", line.run.overrides, "replace a scene entry: path.to[2].key=value (repeatable)")
      ->type_name("PATH=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_run(CLI::App& program, CommandLine& line) {
  CLI::App* verb = program.add_subcommand("run", "run the statics and dynamics of a scene");
  verb->add_option("scene", line.run.scene, "scene file")->required()->type_name("SCENE.yaml");
  verb->add_option("-o,--output", line.run.output, "result file; default <scene stem>.h5 here")->type_name("FILE");
  add_scene_options(*verb, line);
  verb->add_option("--threads", line.run.threads, "number of threads; results do not depend on it")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  verb->add_flag("--force", line.run.force, "overwrite an existing result file");
  verb->add_option("--resume", line.run.resume, "go on at the state recorded in this result file")->type_name("FILE");
  verb->add_flag("--no-progress", line.no_progress, "no progress bar");
}

void add_others(CLI::App& program, CommandLine& line) {
  CLI::App* validate = program.add_subcommand("validate", "check scenes without solving, and say what they hold");
  validate->add_option("scenes", line.scenes, "scene files")->required()->type_name("SCENE.yaml");
  add_scene_options(*validate, line);

  CLI::App* compare = program.add_subcommand("compare", "compare two result files; exit code 1 if they differ");
  compare->add_option("first", line.first, "result file with the tolerances")->required()->type_name("A.h5");
  compare->add_option("second", line.second, "result file")->required()->type_name("B.h5");
  compare->add_option("--rtol", line.compare.rtol, "tolerance relative to the largest value of a data set");
  compare->add_option("--atol", line.compare.atol, "absolute tolerance");
  compare->add_option("--only", line.compare.only, "compare only data sets that match (repeatable)")->type_name("GLOB");
  compare->add_option("--ignore", line.compare.ignore, "leave out data sets that match (repeatable)")
      ->type_name("GLOB");

  CLI::App* info = program.add_subcommand("info", "status, sizes, final values and statistics of a result file");
  info->add_option("file", line.first, "result file")->required()->type_name("OUT.h5");

  program.add_subcommand("schema", "the JSON Schema of the scene format");
}

int dispatch(const CLI::App& program, CommandLine& line) {
  if (program.got_subcommand("run")) {
    line.run.progress = !line.no_progress;
    return app::run(line.run);
  }
  if (program.got_subcommand("validate")) return app::validate(line.scenes, line.run.overrides);
  if (program.got_subcommand("compare")) return app::compare(line.first, line.second, line.compare);
  if (program.got_subcommand("info")) return app::info(line.first);
  return app::schema();
}

base::Verbosity verbosity_of(const CommandLine& line) {
  if (line.quiet) return base::Verbosity::quiet;
  if (line.verbose >= 2) return base::Verbosity::debug;
  return line.verbose == 1 ? base::Verbosity::verbose : base::Verbosity::normal;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine line;
  for (int i = 0; i < argc; ++i) line.run.command_line += (i == 0 ? "" : " ") + std::string(argv[i]);
  CLI::App program("muldi-sim: multibody systems moved by artificial muscles", "muldi-sim");
  program.set_version_flag("--version", app::version_text);
  program.require_subcommand(1);
  program.fallthrough();
  program.add_flag("--quiet", line.quiet, "warnings and errors only");
  program.add_flag("-v", line.verbose, "say more; -vv everything");
  add_run(program, line);
  add_others(program, line);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = program.exit(error);
    return code == 0 ? app::ExitCode::success : app::ExitCode::wrong_input;
  }
  base::set_verbosity(verbosity_of(line));
  try {
    return dispatch(program, line);
  } catch (const base::InputError& error) {
    base::log_plain(error.what());
    return app::ExitCode::wrong_input;
  } catch (const base::EnvironmentError& error) {
    base::log_error(error.what());
    return app::ExitCode::environment_failed;
  } catch (const std::bad_alloc&) {
    base::log_error("out of memory");
    return app::ExitCode::environment_failed;
  } catch (const std::exception& error) {
    base::log_error(std::string("internal error, please report it: ") + error.what());
    return 70;  // EX_SOFTWARE: a bug, none of the documented codes
  }
}
