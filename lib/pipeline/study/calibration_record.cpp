#include <algorithm>

#include "base/build_info.hpp"
#include "base/text.hpp"
#include "pipeline/study/calibrate.hpp"

namespace muldi::pipeline {
namespace {

std::string unit_of(const std::string& unit) { return unit.empty() ? "1" : unit; }

/// Values in row-major order.
std::vector<double> rows_of(const Eigen::MatrixXd& values) {
  const Eigen::MatrixXd transposed = values.transpose();
  return {transposed.data(), transposed.data() + transposed.size()};
}

std::string axis_name(AxisKind kind) {
  return kind == AxisKind::time ? "time" : kind == AxisKind::load ? "load" : "stretch";
}

std::string end_name(math::LeastSquaresEnd end) {
  switch (end) {
    case math::LeastSquaresEnd::converged:
      return "completed";
    case math::LeastSquaresEnd::iteration_limit:
      return "iteration_limit";
    case math::LeastSquaresEnd::interrupted:
      return "interrupted";
    case math::LeastSquaresEnd::cannot_evaluate:
      break;
  }
  return "no_convergence";
}

}  // namespace

void record_calibration(const Calibration& calibration, const std::string& study, results::Recorder& recorder) {
  recorder.set_attribute("", "format", "muldi-sim calibrate");
  recorder.set_attribute("", "muldi_version", std::string(base::build_info().version));
  recorder.set_attribute("", "study", study);
  recorder.set_attribute("", "iterations", std::int64_t{calibration.iterations});
  recorder.set_attribute("", "identifiable", std::int64_t{calibration.quality.combinations.empty() ? 1 : 0});
  recorder.set_attribute("", "warnings", base::joined(calibration.warnings, "\n"));
  const FitQuality& quality = calibration.quality;
  for (std::size_t k = 0; k < calibration.names.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    const std::string group = "parameters/" + calibration.names[k] + "/";
    const auto put = [&](const std::string& name, double value, const std::string& doc) {
      const double values[] = {value};
      recorder.declare_fixed({.path = group + name, .shape = {}, .unit = unit_of(calibration.units[k]), .doc = doc},
                             std::span<const double>(values));
    };
    put("value", calibration.value[at], "fitted");
    put("start", calibration.start[at], "before the fit");
    put("lower", calibration.lower[at], "bound");
    put("upper", calibration.upper[at], "bound");
    if (quality.deviation.size() == 0) continue;
    put("standard_deviation", quality.deviation[at], "from the covariance s^2 (J^T J)^-1; infinite: not determined");
    put("half_width_95", quality.half_width[at], "of the 95 % confidence interval");
  }
  if (quality.singular_values.size() > 0) {
    recorder.declare_fixed({.path = "singular_values",
                            .shape = {static_cast<std::size_t>(quality.singular_values.size())},
                            .unit = "1",
                            .doc = "of the relative sensitivities, over the largest"},
                           std::span<const double>(quality.singular_values.data(),
                                                   static_cast<std::size_t>(quality.singular_values.size())));
  }
  for (const FittedCurve& curve : calibration.curves) {
    const ReferenceCurve& reference = curve.reference;
    const std::string group = "curves/" + reference.name + "/";
    const auto n = static_cast<std::size_t>(reference.at.size());
    const results::Shape shape{n, static_cast<std::size_t>(reference.values.cols())};
    const std::vector<double> at(reference.at.data(), reference.at.data() + reference.at.size());
    recorder.declare_fixed({.path = group + axis_name(reference.axis),
                            .shape = {n},
                            .unit = reference.axis == AxisKind::time ? calibration.time_unit : "1",
                            .doc = "of the reference"},
                           std::span<const double>(at));
    const auto put = [&](const std::string& name, const Eigen::MatrixXd& values, const std::string& doc) {
      const std::vector<double> rows = rows_of(values);
      recorder.declare_fixed({.path = group + name, .shape = shape, .unit = unit_of(reference.unit), .doc = doc},
                             std::span<const double>(rows));
    };
    put("reference", reference.values, "what is fitted to");
    put("before", curve.before, "the scene before the fit");
    put("after", curve.after, "the scene after the fit");
    put("residual", curve.after - reference.values, "after less reference");
  }
  recorder.start();
  recorder.close({.status = end_name(calibration.end), .where = calibration.outcome.sentence, .time = 0.0});
}

}  // namespace muldi::pipeline
