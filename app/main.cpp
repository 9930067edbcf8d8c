/// The command line: options, verbs, exit codes. The only file that knows CLI11.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <system_error>

#include "app/exit_code.hpp"
#include "app/look.hpp"
#include "app/study.hpp"
#include "app/verbs.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/text.hpp"

namespace {

using namespace muldi;

struct CommandLine {
  app::RunArguments run;
  std::vector<std::string> scenes;
  std::string first;
  std::string second;
  results::CompareOptions compare;
  app::LookArguments look;
  app::StudyArguments study;
  bool quiet = false;
  bool no_progress = false;
  bool derivatives = false;
  bool markdown = false;
  bool study_schema = false;
  int verbose = 0;
};

void add_scene_options(CLI::App& verb, CommandLine& line) {
  verb.add_option("--set", line.run.overrides, "replace a scene entry: path.to[2].key=value (repeatable)")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
}

/// Scene, output and the other options of the verbs that write a result file.
void add_run_options(CLI::App& verb, CommandLine& line) {
  verb.add_option("scene", line.run.scene, "scene file")->required()->type_name("SCENE.yaml");
  verb.add_option("-o,--output", line.run.output, "result file; default <scene stem>.h5 here")->type_name("FILE");
  add_scene_options(verb, line);
  verb.add_option("--threads", line.run.threads, "number of threads; results do not depend on it")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  verb.add_flag("--force", line.run.force, "overwrite an existing result file");
  verb.add_flag("--no-progress", line.no_progress, "no progress bar");
  verb.add_flag("!--no-paraview", line.run.paraview, "no side file (.xdmf) by which ParaView opens the result");
}

void add_run(CLI::App& program, CommandLine& line) {
  CLI::App* verb = program.add_subcommand("run", "run the statics and dynamics of a scene");
  add_run_options(*verb, line);
  verb->add_option("--resume", line.run.resume, "go on at the state recorded in this result file, in the same file")
      ->type_name("FILE")
      ->excludes(verb->get_option("--output"))
      ->excludes(verb->get_option("--force"));
}

void add_optimise(CLI::App& program, CommandLine& line) {
  CLI::App* verb = program.add_subcommand("optimise", "find the controls that a scene asks for, and replay them");
  verb->alias("optimize");
  add_run_options(*verb, line);
  verb->add_option("--resume", line.run.resume, "refused with the guess by which to go on instead")->type_name("FILE");
}

void add_check(CLI::App& program, CommandLine& line) {
  CLI::App* verb = program.add_subcommand("check", "check the program itself on a scene");
  verb->add_option("scene", line.run.scene, "scene file")->required()->type_name("SCENE.yaml");
  verb->add_flag("--derivatives", line.derivatives, "Taylor and difference checks of all derivatives")->required();
  add_scene_options(*verb, line);
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
  compare->add_option("--only", line.compare.only, "compare only data sets that match (repeatable)")
      ->type_name("GLOB")
      ->allow_extra_args(false);
  compare->add_option("--ignore", line.compare.ignore, "leave out data sets that match (repeatable)")
      ->type_name("GLOB")
      ->allow_extra_args(false);

  CLI::App* info = program.add_subcommand("info", "status, sizes, final values and statistics of a result file");
  info->add_option("file", line.first, "result file")->required()->type_name("OUT.h5");

  CLI::App* schema = program.add_subcommand("schema", "the JSON Schema of the scene format");
  schema->add_flag("--study", line.study_schema, "that of study files");
  schema->add_flag("--markdown", line.markdown, "a page of every key instead, schemas/SCENE.md")->excludes("--study");
}

/// The verbs for people: pictures, pages, starter scenes, explanations.
void add_look(CLI::App& program, app::LookArguments& look) {
  CLI::App* plot = program.add_subcommand("plot", "curves of one or several result files as a figure");
  plot->add_option("files", look.files, "result files, also running ones")->required()->type_name("OUT.h5");
  plot->add_option("--what", look.what,
                   "what to draw: " + base::joined(app::plot_kinds()) + "; default what the files hold")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LIST");
  plot->add_option("-o,--output", look.output, "figure; default <file stem>.svg here")->type_name("FIG.svg|png|pdf");

  CLI::App* report = program.add_subcommand("report", "one page about a result, with plots and an animated view");
  report->add_option("file", look.files, "result file")->required()->expected(1)->type_name("OUT.h5");
  report->add_option("-o,--output", look.output, "page; default <file stem>.html here")->type_name("REPORT.html");

  CLI::App* paraview = program.add_subcommand("paraview", "write the side file by which ParaView opens a result");
  paraview->add_option("file", look.files, "result file")->required()->expected(1)->type_name("OUT.h5");

  CLI::App* starter = program.add_subcommand("new", "a commented scene to begin with");
  starter->add_option("kind", look.word, app::starter_kinds())->type_name("KIND");
  starter->add_option("-o,--output", look.output, "scene file; default standard output")->type_name("SCENE.yaml");
  starter->add_flag("--force", look.force, "overwrite an existing file");

  CLI::App* explain = program.add_subcommand("explain", "meaning, unit, default and range of a key of scenes");
  explain->add_option("key", look.word, "e.g. muscles.*.section; without it the sections of a scene")
      ->type_name("KEY.PATH");
}

/// The verbs about many runs of a scene.
void add_studies(CLI::App& program, CommandLine& line) {
  app::StudyArguments& study = line.study;
  const auto common = [&](CLI::App& verb) {
    verb.add_option("study", study.study, "study file")->required()->type_name("STUDY.yaml");
    verb.add_option("--set", study.overrides, "replace an entry of the scene: path.to[2].key=value (repeatable)")
        ->type_name("PATH=VALUE")
        ->allow_extra_args(false);
    verb.add_flag("--force", study.force, "overwrite what is there");
    verb.add_flag("--no-progress", line.no_progress, "no progress bar");
  };
  CLI::App* sweep = program.add_subcommand("sweep", "run a scene at many points, into one table");
  common(*sweep);
  sweep->add_option("-o,--output", study.output, "table; default <study stem>.h5 here, and .csv beside it")
      ->type_name("TABLE.h5");
  sweep->add_option("--jobs", study.jobs, "points at a time, each in a process; tasks of a Slurm array")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  sweep->add_option("--shard", study.shard, "only every n-th point, from the k-th one")->type_name("K/N");
  sweep->add_flag("--merge", study.merge, "run nothing; make the table of what all shards have finished")
      ->excludes(sweep->get_option("--shard"));
  sweep->add_option("--slurm", study.slurm, "write the script of a Slurm array job with --jobs tasks, run nothing")
      ->type_name("SCRIPT.sh");
  CLI::App* fit = program.add_subcommand("calibrate", "fit parameters of a scene to a result or to measured data");
  common(*fit);
  fit->add_option("-o,--output", study.output, "calibrated scene; default <scene stem>_calibrated.yaml here")
      ->type_name("SCENE.yaml");
  fit->add_option("--results", study.results, "what was found, with residual curves; default <study stem>.h5 here")
      ->type_name("FIT.h5");
}

int dispatch(const CLI::App& program, CommandLine& line) {
  if (program.got_subcommand("run")) {
    line.run.progress = !line.no_progress;
    return app::run(line.run);
  }
  if (program.got_subcommand("optimise")) {
    line.run.progress = !line.no_progress;
    return app::optimise(line.run);
  }
  if (program.got_subcommand("check")) return app::check_derivatives(line.run.scene, line.run.overrides);
  if (program.got_subcommand("validate")) return app::validate(line.scenes, line.run.overrides);
  if (program.got_subcommand("compare")) return app::compare(line.first, line.second, line.compare);
  if (program.got_subcommand("info")) return app::info(line.first);
  if (program.got_subcommand("plot")) return app::plot(line.look);
  if (program.got_subcommand("report")) return app::report(line.look);
  if (program.got_subcommand("paraview")) return app::paraview(line.look);
  if (program.got_subcommand("new")) return app::starter(line.look);
  if (program.got_subcommand("explain")) return app::explain(line.look);
  line.study.progress = !line.no_progress;
  if (program.got_subcommand("sweep")) return app::sweep(line.study);
  if (program.got_subcommand("calibrate")) return app::calibrate(line.study);
  return app::schema(line.study_schema, line.markdown);
}

std::vector<std::string> names_of(const std::vector<const CLI::App*>& verbs) {
  std::vector<std::string> names;
  names.reserve(verbs.size());
  for (const CLI::App* verb : verbs) names.push_back(verb->get_name());
  return names;
}

/// One line in the form of all our errors; a misspelt word with the nearest known one.
std::string usage_error(const CLI::App* program, const CLI::Error& error) {
  const auto verbs = names_of(program->get_subcommands([](const CLI::App*) { return true; }));
  const std::vector<CLI::App*> chosen = program->get_subcommands();
  const CLI::App& asked = chosen.empty() ? *program : *chosen.front();
  const std::vector<std::string> rest = program->remaining(true);
  std::string text = error.what();
  if (chosen.empty() && !rest.empty() && rest.front()[0] != '-') {
    text = base::format("no verb '{}'", rest.front()) + base::did_you_mean(rest.front(), verbs);
  } else if (!rest.empty()) {
    std::vector<std::string> options;
    for (const CLI::Option* option : asked.get_options()) {
      for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
    }
    const std::string_view near = base::nearest(rest.front(), options);
    text = base::format("unexpected '{}'{}", rest.front(),
                        near.empty() ? "" : base::format(" (did you mean '{}'?)", near));
  } else if (chosen.empty()) {
    text = "give a verb: " + base::joined(verbs, ", ");
  }
  return base::format("error: {}; see 'muldi-sim{} --help'\n", text, chosen.empty() ? "" : " " + asked.get_name());
}

base::Verbosity verbosity_of(const CommandLine& line) {
  if (line.quiet) return base::Verbosity::quiet;
  if (line.verbose >= 2) return base::Verbosity::debug;
  return line.verbose == 1 ? base::Verbosity::verbose : base::Verbosity::normal;
}

int out_of_memory() {
  base::log_error("out of memory: `muldi-sim validate` estimates what a scene takes; take fewer cells or bodies");
  return app::ExitCode::environment_failed;
}

int guarded(const CLI::App& program, CommandLine& line) {
  try {
    const int code = dispatch(program, line);
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
    base::log_error("cannot write the output");
    return app::ExitCode::environment_failed;
  } catch (const base::InputError& error) {
    base::log_plain(error.what());
    return app::ExitCode::wrong_input;
  } catch (const base::EnvironmentError& error) {
    base::log_error(error.what());
    return app::ExitCode::environment_failed;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  } catch (const std::exception& error) {
    // A thread that cannot be made for want of room for its stack.
    const auto* failure = dynamic_cast<const std::system_error*>(&error);
    if (failure != nullptr && failure->code() == std::errc::resource_unavailable_try_again) return out_of_memory();
    base::log_error(std::string("internal error, please report it: ") + error.what());
    return 70;  // EX_SOFTWARE: a bug, none of the documented codes
  }
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine line;
  for (int i = 0; i < argc; ++i) line.run.command_line += (i == 0 ? "" : " ") + std::string(argv[i]);
  CLI::App program("muldi-sim: multibody systems moved by artificial muscles", "muldi-sim");
  program.set_version_flag("--version", app::version_text);
  program.failure_message(usage_error);
  program.fallthrough();
  program.add_flag("--quiet", line.quiet, "warnings and errors only");
  program.add_flag("-v", line.verbose, "say more; -vv everything");
  add_run(program, line);
  add_optimise(program, line);
  add_check(program, line);
  add_others(program, line);
  add_look(program, line.look);
  add_studies(program, line);
  line.study.program = argv[0];
  try {
    program.parse(argc, argv);
    if (program.get_subcommands().empty()) throw CLI::RequiredError("a verb");
  } catch (const CLI::ParseError& error) {
    const int code = program.exit(error);
    return code == 0 ? app::ExitCode::success : app::ExitCode::wrong_input;
  }
  base::set_verbosity(verbosity_of(line));
  return guarded(program, line);
}
