#pragma once
/// Nonlinear least squares with bounds: min 1/2 |r(x)|^2, lower <= x <= upper.
///
/// Gauss-Newton steps with Levenberg's damping in scaled variables, on the variables that are not held by a bound,
/// clipped to the box; converges quadratically where the residuals vanish. Own, since Eigen's unsupported
/// Levenberg-Marquardt knows neither bounds nor a Jacobian with deficient rank, and Ceres is a large dependency for
/// some ten unknowns.
#include <Eigen/Core>
#include <functional>

namespace muldi::math {

struct LeastSquaresProblem {
  Eigen::VectorXd lower;  ///< (n)
  Eigen::VectorXd upper;  ///< (n), lower < upper
  /// r (m) and, unless null, J = dr/dx (m, n); false where r cannot be evaluated.
  std::function<bool(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J)> evaluate;
};

struct LeastSquaresOptions {
  int max_iterations = 60;
  double step_tolerance = 1e-11;      ///< of x over upper - lower
  double gradient_tolerance = 1e-13;  ///< of the projected gradient over |J| |r|, in scaled variables
  double stall_decrease = 1e-6;  ///< of the cost, relative: less three times in a row is a flat valley, and the end
  double rank_tolerance = 1e-9;  ///< singular values below it, over the largest, count as 0
};

enum class LeastSquaresEnd { converged, iteration_limit, cannot_evaluate, interrupted };

struct LeastSquaresResult {
  LeastSquaresEnd end = LeastSquaresEnd::iteration_limit;
  Eigen::VectorXd x = {};  ///< best (n)
  Eigen::VectorXd r = {};  ///< there
  Eigen::MatrixXd J = {};
  int iterations = 0;
  double cost = 0.0;  ///< 1/2 |r|^2
};

/// Minimises from x0, which is moved into the box. `watch` is called at every accepted point; false ends the search.
LeastSquaresResult minimise(const LeastSquaresProblem& problem, const Eigen::VectorXd& x0,
                            const LeastSquaresOptions& options,
                            const std::function<bool(int iteration, double cost)>& watch = {});

}  // namespace muldi::math
