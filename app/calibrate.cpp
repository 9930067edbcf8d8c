#include "pipeline/study/calibrate.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "app/exit_code.hpp"
#include "app/interrupt.hpp"
#include "app/study.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/special_file.hpp"
#include "base/text.hpp"
#include "results/hdf5_recorder.hpp"

namespace muldi::app {
namespace {

namespace fs = std::filesystem;
using math::LeastSquaresEnd;

std::string interval(double half_width) {
  if (std::isnan(half_width)) return "?";
  return std::isinf(half_width) ? "not determined" : base::format("{:.2g}", half_width);
}

std::string table_of(const pipeline::Calibration& fit) {
  std::size_t width = 10;
  for (const std::string& name : fit.names) width = std::max(width, name.size());
  for (const pipeline::FittedCurve& curve : fit.curves) width = std::max(width, curve.reference.name.size());
  std::string text = base::format("{:{}} {:>14} {:>16} {:>15}\n", "parameter", width, "start", "fitted", "+- (95 %)");
  for (std::size_t k = 0; k < fit.names.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    text += base::format("{:{}} {:14.6g} {:16.10g} {:>15} {}\n", fit.names[k], width, fit.start[at], fit.value[at],
                         interval(fit.quality.half_width[at]), fit.units[k]);
  }
  text += base::format("{:{}} {:>14} {:>16} {:>15}\n", "compared", width, "rms before", "rms after", "largest after");
  for (const pipeline::FittedCurve& curve : fit.curves) {
    text += base::format("{:{}} {:14.6g} {:16.6g} {:15.6g} {}\n", curve.reference.name, width, curve.rms_before(),
                         curve.rms_after(), curve.largest_after(), curve.reference.unit);
  }
  return text;
}

/// The comment at the head of the calibrated scene.
std::string heading_of(const pipeline::Calibration& fit, const StudyArguments& arguments) {
  std::string text =
      base::format("# Calibrated by muldi-sim calibrate {}:\n", fs::path(arguments.study).filename().string());
  for (std::size_t k = 0; k < fit.names.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    text += base::format("#   {} = {:.10g} +- {} {}\n", fit.names[k], fit.value[at],
                         interval(fit.quality.half_width[at]), fit.units[k]);
  }
  return text;
}

void require_writable(const std::string& path, const StudyArguments& arguments) {
  base::refuse_unwritable_output(path);
  if (arguments.force || !fs::exists(path)) return;
  throw base::InputError(base::format("'{}' exists; give --force to overwrite it", path));
}

void write_scene(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out << text << std::flush;
  if (!out) throw base::EnvironmentError("cannot write '" + path + "'");
}

}  // namespace

int calibrate(const StudyArguments& arguments) {
  const scene::CalibrateStudy study = scene::read_calibrate_study(arguments.study);
  const scene::SceneText scene = scene::scene_of_study(study.origin, study.scene, study.set, arguments.overrides);
  const std::string output =
      arguments.output.empty() ? fs::path(study.scene).stem().string() + "_calibrated.yaml" : arguments.output;
  const std::string record =
      arguments.results.empty() ? fs::path(arguments.study).stem().string() + ".h5" : arguments.results;
  require_writable(output, arguments);
  require_writable(record, arguments);
  watch_interrupts();
  pipeline::CalibrateCalls calls;
  calls.interrupted = interrupt_asked;
  calls.iterate = [](int iteration, double cost) {
    base::log_verbose(base::format("iteration {}: cost {:.6g}", iteration, cost));
  };
  const pipeline::Calibration fit = pipeline::calibrate(study, scene, calls);
  if (fit.end == LeastSquaresEnd::cannot_evaluate) {
    base::log_error(base::format("the scene cannot be run at the start: {}: {}",
                                 variational::name_of(fit.outcome.status), fit.outcome.sentence));
    return exit_code(fit.outcome.status);
  }
  std::fputs(table_of(fit).c_str(), stdout);
  for (const std::string& warning : fit.warnings) base::log_warning(warning);
  results::Hdf5Recorder recorder(
      {.path = record, .mode = arguments.force ? results::Output::Mode::overwrite : results::Output::Mode::create});
  pipeline::record_calibration(fit, fs::path(arguments.study).filename().string(), recorder);
  write_scene(output, scene.replaced(fit.overrides, heading_of(fit, arguments)));
  base::log_info(base::format("{}: {}, {}", fit.end == LeastSquaresEnd::converged ? "converged" : "not converged",
                              output, record));
  if (fit.end == LeastSquaresEnd::interrupted) return ExitCode::interrupted;
  return fit.end == LeastSquaresEnd::converged ? ExitCode::success : ExitCode::numerics_failed;
}

}  // namespace muldi::app
