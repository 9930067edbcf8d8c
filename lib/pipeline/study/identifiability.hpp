#pragma once
/// What a least-squares fit tells of its parameters: confidence intervals, and what the data do not determine.
#include <Eigen/Core>
#include <string>
#include <vector>

namespace muldi::pipeline {

/// Parameters that can move together without effect on what is compared, or with one that is lost in the residuals:
/// d log p_k = share_k.
struct FreeCombination {
  bool weak = false;  ///< has an effect, but the confidence interval along it is wider than half the values
  std::vector<std::size_t> parameters = {};
  std::vector<double> shares = {};  ///< relative changes, the largest 1
};

struct FitQuality {
  Eigen::VectorXd deviation;   ///< standard deviations; infinite where the data do not determine the parameter
  Eigen::VectorXd half_width;  ///< of the 95 % confidence interval (Student's t)
  double residual_deviation = 0.0;
  long freedom = 0;                           ///< data less parameters
  Eigen::VectorXd singular_values = {};       ///< of the relative sensitivities, over the largest
  std::vector<FreeCombination> combinations;  ///< empty: all parameters are determined
};

/// `J` (m, n) and `r` (m) at the solution, `theta` there, `scale` what stands for a parameter that is 0.
/// The covariance is s^2 (J^T J)^-1, s^2 = |r|^2/(m - n). Directions whose singular value is below `tolerance` of the
/// largest have no effect.
FitQuality fit_quality(const Eigen::MatrixXd& J, const Eigen::VectorXd& r, const Eigen::VectorXd& theta,
                       const Eigen::VectorXd& scale, double tolerance = 1e-8);

/// A sentence about a combination.
std::string describe(const FreeCombination& combination, const std::vector<std::string>& names);

/// The 97.5 % quantile of Student's t.
double student_quantile(long freedom);

}  // namespace muldi::pipeline
