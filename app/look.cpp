#include "app/look.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "app/drawing.hpp"
#include "app/exit_code.hpp"
#include "app/python_program.hpp"
#include "base/diagnostic.hpp"
#include "base/error.hpp"
#include "base/special_file.hpp"
#include "base/text.hpp"
#include "results/result_file.hpp"
#include "results/xdmf.hpp"
#include "scene/explain.hpp"
#include "scene/starter.hpp"

namespace muldi::app {
namespace {

std::string output_of(const LookArguments& arguments, const std::string& ending) {
  if (!arguments.output.empty()) return arguments.output;
  return std::filesystem::path(arguments.files.front()).stem().string() + ending;
}

/// The file of this ending, or an error.
void require_ending(const std::string& path, const std::vector<std::string>& endings) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (std::find(endings.begin(), endings.end(), ending) != endings.end()) return;
  throw base::InputError(base::format("-o: '{}' must end in {}", path, base::joined(endings, ", ")));
}

/// Refuses what is no result of ours before a Python program is started.
void check_results(const std::vector<std::string>& files) {
  for (const std::string& path : files) {
    if (results::ResultFile(path).text("status").empty()) {
      throw base::InputError(base::format("'{}' is no result of muldi-sim: it has no status", path));
    }
  }
}

}  // namespace

const std::vector<std::string>& plot_kinds() {
  static const std::vector<std::string> kinds{"energy",   "joints", "muscles", "controls",    "points", "probes",
                                              "momentum", "solver", "optimum", "convergence", "view"};
  return kinds;
}

std::string starter_kinds() {
  std::vector<std::string> rows;
  for (const scene::StarterText& each : scene::starter_texts())
    rows.push_back(base::format("{}: {}", each.kind, each.doc));
  return base::joined(rows, "; ");
}

int plot(const LookArguments& arguments) {
  for (const std::string& kind : arguments.what) {
    const auto& known = plot_kinds();
    if (std::find(known.begin(), known.end(), kind) != known.end()) continue;
    const std::string_view near = base::nearest(kind, known);
    throw base::InputError(base::format("--what: no plot {}{}; known: {}", base::in_quotes(kind),
                                        near.empty() ? "" : base::format(" (did you mean '{}'?)", near),
                                        base::joined(known)));
  }
  const std::string output = output_of(arguments, ".svg");
  require_ending(output, {".svg", ".png", ".pdf"});
  base::refuse_unwritable_output(output);
  check_results(arguments.files);
  if (std::count(arguments.what.begin(), arguments.what.end(), "view") != 0) {
    if (arguments.what.size() != 1 || arguments.files.size() != 1) {
      throw base::InputError("--what: view is a picture of one file: ask for it alone");
    }
    become_python("still", {"-o", output, "--", arguments.files.front()},
                  results::to_json(drawing_in(arguments.files.front())));
  }
  std::vector<std::string> words{"-o", output};
  if (!arguments.what.empty()) words.insert(words.end(), {"--what", base::joined(arguments.what, ",")});
  words.emplace_back("--");
  words.insert(words.end(), arguments.files.begin(), arguments.files.end());
  become_python("plot", words);
}

int report(const LookArguments& arguments) {
  const std::string output = output_of(arguments, ".html");
  require_ending(output, {".html", ".htm"});
  base::refuse_unwritable_output(output);
  check_results(arguments.files);
  become_python("report", {"-o", output, "--", arguments.files.front()},
                results::to_json(drawing_in(arguments.files.front())));
}

int paraview(const LookArguments& arguments) {
  const std::string& file = arguments.files.front();
  check_results(arguments.files);
  const std::vector<std::string> written = results::write_xdmf(file, drawing_in(file));
  if (written.empty()) {
    throw base::InputError(base::format(
        "'{}' holds nothing to draw: no bodies, muscles or springs, and no fields of solids (record.fields)", file));
  }
  for (const std::string& path : written) std::printf("%s\n", path.c_str());
  return ExitCode::success;
}

int starter(const LookArguments& arguments) {
  const std::string text =
      scene::starter(arguments.word.empty() ? scene::starter_texts().front().kind : std::string_view(arguments.word));
  if (arguments.output.empty()) {
    std::fputs(text.c_str(), stdout);
    return ExitCode::success;
  }
  if (std::filesystem::exists(arguments.output) && !arguments.force) {
    throw base::InputError(base::format("'{}' exists; give --force to overwrite it", arguments.output));
  }
  base::refuse_unwritable_output(arguments.output);
  std::ofstream out(arguments.output, std::ios::binary | std::ios::trunc);
  out << text << std::flush;
  if (!out) throw base::EnvironmentError("cannot write '" + arguments.output + "'");
  return ExitCode::success;
}

int explain(const LookArguments& arguments) {
  std::fputs(scene::explain(arguments.word).c_str(), stdout);
  return ExitCode::success;
}

}  // namespace muldi::app
