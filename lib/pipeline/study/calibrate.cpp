#include "pipeline/study/calibrate.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"

namespace muldi::pipeline {
namespace {

constexpr double at_bound = 1e-9;  // of the distance of the bounds

/// All curves as residuals and their Jacobian.
class Residuals {
 public:
  Residuals(const Predictor& predictor, const std::vector<ReferenceCurve>& curves, std::size_t n_parameters)
      : predictor_(predictor), curves_(curves), n_parameters_(static_cast<Eigen::Index>(n_parameters)) {
    for (const ReferenceCurve& curve : curves) n_rows_ += curve.values.size();
  }

  Eigen::Index n_rows() const { return n_rows_; }
  const Outcome& outcome() const { return outcome_; }

  bool evaluate(const Eigen::VectorXd& theta, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
    std::vector<PredictedCurve> predicted;
    try {
      outcome_ = predictor_.predict(theta, J != nullptr, predicted);
    } catch (const base::InputError& error) {
      outcome_ = {.status = variational::Status::infeasible, .sentence = error.what()};
    }
    if (!outcome_.completed()) return false;
    r.resize(n_rows_);
    if (J != nullptr) J->resize(n_rows_, n_parameters_);
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      const ReferenceCurve& curve = curves_[i];
      const Eigen::Index n = curve.values.size();
      const double factor = curve.weight / (curve.scale * std::sqrt(static_cast<double>(n)));
      r.segment(row, n) = factor * (predicted[i].values - curve.values).reshaped();
      for (Eigen::Index k = 0; J != nullptr && k < n_parameters_; ++k) {
        J->col(k).segment(row, n) = factor * predicted[i].slopes[static_cast<std::size_t>(k)].reshaped();
      }
      row += n;
    }
    return r.allFinite();
  }

 private:
  const Predictor& predictor_;
  const std::vector<ReferenceCurve>& curves_;
  Eigen::Index n_parameters_;
  Eigen::Index n_rows_ = 0;
  Outcome outcome_;
};

void warn(Calibration& result) {
  for (const FreeCombination& combination : result.quality.combinations) {
    result.warnings.push_back(describe(combination, result.names));
  }
  for (Eigen::Index k = 0; k < result.value.size(); ++k) {
    const std::string& name = result.names[static_cast<std::size_t>(k)];
    const double width = result.upper[k] - result.lower[k];
    const bool low = result.value[k] - result.lower[k] <= at_bound * width;
    if (low || result.upper[k] - result.value[k] <= at_bound * width) {
      result.warnings.push_back(
          base::format("{} is at its {} bound: widen it if the physics allow", name, low ? "lower" : "upper"));
    }
  }
}

}  // namespace

double FittedCurve::rms(const Eigen::MatrixXd& values) const {
  return (values - reference.values).norm() / std::sqrt(static_cast<double>(values.size()));
}

Calibration calibrate(const scene::CalibrateStudy& study, const scene::SceneText& scene, const CalibrateCalls& calls) {
  const Parameters parameters(study, scene);
  const base::UnitSystem units = scene.read({}).units;
  std::vector<ReferenceCurve> curves = read_references(study, units);
  const Predictor predictor(parameters, curves);
  Residuals residuals(predictor, curves, parameters.size());
  if (residuals.n_rows() < static_cast<Eigen::Index>(parameters.size())) {
    throw base::InputError(
        {scene::error_at(study.origin, base::format("{} values of the reference cannot determine {} parameters",
                                                    residuals.n_rows(), parameters.size()))});
  }
  Calibration result{.names = parameters.names(),
                     .units = parameters.units(),
                     .time_unit = units.time(),
                     .lower = parameters.lower(),
                     .upper = parameters.upper(),
                     .start = parameters.start(),
                     .value = parameters.start()};
  std::vector<PredictedCurve> before;
  result.outcome = predictor.predict(result.start, false, before);
  if (!result.outcome.completed()) {
    result.end = math::LeastSquaresEnd::cannot_evaluate;
    return result;
  }
  const math::LeastSquaresProblem problem{
      .lower = parameters.lower(), .upper = parameters.upper(), .evaluate = [&](const auto& x, auto& r, auto* J) {
        return residuals.evaluate(x, r, J);
      }};
  const math::LeastSquaresResult found =
      math::minimise(problem, parameters.start(), {}, [&](int iteration, double cost) {
        if (calls.iterate) calls.iterate(iteration, cost);
        return !(calls.interrupted && calls.interrupted());
      });
  result.end = found.end;
  result.iterations = found.iterations;
  result.value = found.x;
  result.overrides = parameters.overrides(found.x);
  if (found.end == math::LeastSquaresEnd::cannot_evaluate) {
    result.outcome = residuals.outcome();
    return result;
  }
  std::vector<PredictedCurve> after;
  result.outcome = predictor.predict(found.x, false, after);
  result.quality = fit_quality(found.J, found.r, found.x, result.upper - result.lower);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    result.curves.push_back({.reference = curves[i], .before = before[i].values, .after = after[i].values});
  }
  warn(result);
  return result;
}

}  // namespace muldi::pipeline
