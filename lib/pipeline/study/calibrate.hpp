#pragma once
/// The `calibrate` pipeline: parameters of a scene fitted to data by bounded least squares with exact sensitivities.
#include <functional>
#include <string>
#include <vector>

#include "math/bounded_least_squares.hpp"
#include "pipeline/outcome.hpp"
#include "pipeline/study/identifiability.hpp"
#include "pipeline/study/prediction.hpp"
#include "results/recorder.hpp"

namespace muldi::pipeline {

/// One compared curve with what the scene gives before and after the fit.
struct FittedCurve {
  ReferenceCurve reference = {};
  Eigen::MatrixXd before = {};
  Eigen::MatrixXd after = {};

  double rms_before() const { return rms(before); }
  double rms_after() const { return rms(after); }
  double largest_before() const { return (before - reference.values).cwiseAbs().maxCoeff(); }
  double largest_after() const { return (after - reference.values).cwiseAbs().maxCoeff(); }

 private:
  double rms(const Eigen::MatrixXd& values) const;
};

struct Calibration {
  std::vector<std::string> names = {};
  std::vector<std::string> units = {};
  std::string time_unit = {};  ///< of the scene
  Eigen::VectorXd lower = {};
  Eigen::VectorXd upper = {};
  Eigen::VectorXd start = {};
  Eigen::VectorXd value = {};
  FitQuality quality = {};
  std::vector<FittedCurve> curves = {};
  math::LeastSquaresEnd end = math::LeastSquaresEnd::iteration_limit;
  int iterations = 0;
  Outcome outcome = {};                     ///< of the run at the start, where that fails
  std::vector<std::string> warnings = {};   ///< what is not determined, bounds that are reached
  std::vector<std::string> overrides = {};  ///< the values as of --set
};

struct CalibrateCalls {
  std::function<bool()> interrupted = {};
  std::function<void(int iteration, double cost)> iterate = {};
};

/// Fits. Residuals are weight (scene - reference)/(scale sqrt(n)) of each curve of n values.
/// InputError with all that is wrong with the study before anything runs.
Calibration calibrate(const scene::CalibrateStudy& study, const scene::SceneText& scene, const CalibrateCalls& calls);

/// Puts down parameters, intervals and residual curves; starts and closes the recorder.
void record_calibration(const Calibration& calibration, const std::string& study, results::Recorder& recorder);

}  // namespace muldi::pipeline
