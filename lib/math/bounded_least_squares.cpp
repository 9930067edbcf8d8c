#include "math/bounded_least_squares.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace muldi::math {
namespace {

/// Variables that a bound holds: at it, with the gradient pointing out of the box.
std::vector<Eigen::Index> free_variables(const Eigen::VectorXd& z, const Eigen::VectorXd& gradient) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const bool held = (z[i] <= 0.0 && gradient[i] > 0.0) || (z[i] >= 1.0 && gradient[i] < 0.0);
    if (!held) free.push_back(i);
  }
  return free;
}

/// The damped Gauss-Newton step of least norm on the free variables; directions without effect stay at rest.
Eigen::VectorXd step_of(const Eigen::MatrixXd& J, const Eigen::VectorXd& r, double damping, double rank_tolerance) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& s = svd.singularValues();
  Eigen::VectorXd c = -(svd.matrixU().transpose() * r);
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    c[i] = s[i] > rank_tolerance * s[0] ? c[i] * s[i] / (s[i] * s[i] + damping * s[0] * s[0]) : 0.0;
  }
  return svd.matrixV() * c;
}

}  // namespace

LeastSquaresResult minimise(const LeastSquaresProblem& problem, const Eigen::VectorXd& x0,
                            const LeastSquaresOptions& options,
                            const std::function<bool(int iteration, double cost)>& watch) {
  const Eigen::VectorXd width = problem.upper - problem.lower;
  const auto x_of = [&](const Eigen::VectorXd& z) {
    return Eigen::VectorXd(problem.lower + width.cwiseProduct(z))
        .cwiseMax(problem.lower)
        .cwiseMin(problem.upper)
        .eval();
  };
  // z in [0, 1]: where all bounds are equally far.
  Eigen::VectorXd z = (x0 - problem.lower).cwiseQuotient(width).cwiseMax(0.0).cwiseMin(1.0);
  LeastSquaresResult best;
  best.x = x_of(z);
  if (!problem.evaluate(best.x, best.r, &best.J)) {
    best.end = LeastSquaresEnd::cannot_evaluate;
    return best;
  }
  best.cost = 0.5 * best.r.squaredNorm();
  constexpr int most_stalls = 3;
  double damping = 0.0;
  int stalls = 0;
  for (best.iterations = 0; best.iterations < options.max_iterations; ++best.iterations) {
    if (watch && !watch(best.iterations, best.cost)) {
      best.end = LeastSquaresEnd::interrupted;
      return best;
    }
    const Eigen::MatrixXd J = best.J * width.asDiagonal();
    const Eigen::VectorXd gradient = J.transpose() * best.r;
    const std::vector<Eigen::Index> free = free_variables(z, gradient);
    const double size = J.norm() * best.r.norm();
    double projected = 0.0;
    for (const Eigen::Index i : free) projected = std::max(projected, std::abs(gradient[i]));
    if (free.empty() || projected <= options.gradient_tolerance * size) {
      best.end = LeastSquaresEnd::converged;
      return best;
    }
    Eigen::MatrixXd on_free(J.rows(), static_cast<Eigen::Index>(free.size()));
    for (std::size_t k = 0; k < free.size(); ++k) on_free.col(static_cast<Eigen::Index>(k)) = J.col(free[k]);
    bool accepted = false;
    while (!accepted) {
      const Eigen::VectorXd step = step_of(on_free, best.r, damping, options.rank_tolerance);
      Eigen::VectorXd trial = z;
      for (std::size_t k = 0; k < free.size(); ++k) trial[free[k]] += step[static_cast<Eigen::Index>(k)];
      trial = trial.cwiseMax(0.0).cwiseMin(1.0);
      const double moved = (trial - z).lpNorm<Eigen::Infinity>();
      const double expected = best.cost - 0.5 * (best.r + J * (trial - z)).squaredNorm();
      LeastSquaresResult next;
      next.x = x_of(trial);
      const bool valid = problem.evaluate(next.x, next.r, &next.J);
      next.cost = valid ? 0.5 * next.r.squaredNorm() : std::numeric_limits<double>::infinity();
      accepted = next.cost <= best.cost;
      const double gain = expected > 0.0 ? (best.cost - next.cost) / expected : 0.0;
      if (accepted) {
        stalls = best.cost - next.cost < options.stall_decrease * best.cost ? stalls + 1 : 0;
        next.iterations = best.iterations;
        best = std::move(next);
        z = trial;
        damping = gain > 0.75   ? (damping < 1e-8 ? 0.0 : 0.1 * damping)
                  : gain > 0.25 ? damping
                                : std::max(4.0 * damping, 1e-6);
      } else {
        damping = std::max(10.0 * damping, 1e-6);
      }
      if (moved <= options.step_tolerance || damping > 1e12 || stalls == most_stalls) {
        ++best.iterations;
        best.end = LeastSquaresEnd::converged;
        return best;
      }
    }
  }
  return best;
}

}  // namespace muldi::math
