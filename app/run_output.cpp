#include "app/run_output.hpp"

#include <cmath>
#include <filesystem>

#include "app/drawing.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/text.hpp"
#include "results/xdmf.hpp"

namespace muldi::app {

void print(const std::vector<base::Diagnostic>& diagnostics) {
  for (const base::Diagnostic& diagnostic : diagnostics) base::log_plain(base::to_string(diagnostic));
}

results::Output output_of(const RunArguments& arguments) {
  results::Output output;
  if (!arguments.resume.empty()) {
    output.path = arguments.resume;
    output.mode = results::Output::Mode::resume;
    return output;
  }
  output.path =
      arguments.output.empty() ? std::filesystem::path(arguments.scene).stem().string() + ".h5" : arguments.output;
  output.mode = arguments.force ? results::Output::Mode::overwrite : results::Output::Mode::create;
  return output;
}

void report_phases(const base::Phases& phases) {
  std::vector<std::string> parts;
  for (const base::Phase& phase : phases.all()) parts.push_back(base::format("{} {:.3g} s", phase.name, phase.seconds));
  base::log_verbose("wall time: " + base::joined(parts, ", "));
}

void report_failure(const pipeline::Outcome& outcome, pipeline::Task task, const scene::Scene& scene,
                    const std::string& kept) {
  const std::string at =
      std::isnan(outcome.time) ? "" : base::format(" at t = {:.6g} {}", outcome.time, scene.units.time());
  base::log_error(
      base::format("{}{}: {} ({})", variational::name_of(outcome.status), at, base::trimmed(outcome.sentence), kept));
  const pipeline::Advice advice = pipeline::advice_on(outcome.status, task);
  if (advice.meaning.empty()) return;
  base::log_plain(base::format("  why: {}", advice.meaning));
  base::log_plain(base::format("  try: {}", advice.remedy));
}

void write_side_files(const std::string& path, const scene::Scene& scene) {
  try {
    for (const std::string& side : results::write_xdmf(path, drawing_of(scene))) {
      base::log_verbose(base::format("for ParaView: {}", side));
    }
  } catch (const base::EnvironmentError& error) {
    base::log_warning(base::format("no side file for ParaView: {}", error.what()));
  }
}

}  // namespace muldi::app
