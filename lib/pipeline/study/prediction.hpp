#pragma once
/// What a scene gives where the reference has points, with its derivatives by the parameters.
#include <string>
#include <vector>

#include "pipeline/outcome.hpp"
#include "pipeline/study/parameters.hpp"
#include "pipeline/study/reference_curves.hpp"

namespace muldi::pipeline {

/// One compared curve at some values of the parameters.
struct PredictedCurve {
  Eigen::MatrixXd values = {};               ///< as ReferenceCurve::values
  std::vector<Eigen::MatrixXd> slopes = {};  ///< of each parameter, if asked for
};

class Predictor {
 public:
  /// Checks that the scene gives what is compared; reference points outside of what the scene runs are cut off, in the
  /// curves too. InputError, located in the study.
  Predictor(const Parameters& parameters, std::vector<ReferenceCurve>& curves);

  /// Runs what is needed at theta; an outcome that is not completed has no values.
  Outcome predict(const Eigen::VectorXd& theta, bool with_slopes, std::vector<PredictedCurve>& out) const;

 private:
  struct Group;
  Outcome predict_group(AxisKind axis, const Eigen::VectorXd& theta, const std::vector<std::vector<Variant>>& variants,
                        std::vector<PredictedCurve>& out) const;

  const Parameters& parameters_;
  const std::vector<ReferenceCurve>& curves_;
};

/// Weights that interpolate rows at the points `axis` (ascending or descending) to `at`: cubic through the four
/// nearest, exact at a point (rows of `at`, points of `axis`).
Eigen::MatrixXd interpolation(const Eigen::VectorXd& axis, const Eigen::VectorXd& at);

}  // namespace muldi::pipeline
