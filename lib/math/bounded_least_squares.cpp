#include "math/bounded_least_squares.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
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

/// The search in z = (x - lower)/(upper - lower), where all bounds are equally far.
class Search {
 public:
  Search(const LeastSquaresProblem& problem, const Eigen::VectorXd& x0, const LeastSquaresOptions& options)
      : problem_(problem),
        options_(options),
        width_(problem.upper - problem.lower),
        z_((x0 - problem.lower).cwiseQuotient(width_).cwiseMax(0.0).cwiseMin(1.0)) {
    best_.x = x_of(z_);
  }

  LeastSquaresResult& best() { return best_; }

  bool begin() {
    const bool valid = problem_.evaluate(best_.x, best_.r, &best_.J);
    best_.cost = valid ? 0.5 * best_.r.squaredNorm() : 0.0;
    return valid;
  }

  /// Linearises at the best point; true if its projected gradient vanishes.
  bool is_stationary() {
    J_ = best_.J * width_.asDiagonal();
    const Eigen::VectorXd gradient = J_.transpose() * best_.r;
    free_ = free_variables(z_, gradient);
    double projected = 0.0;
    for (const Eigen::Index i : free_) projected = std::max(projected, std::abs(gradient[i]));
    return free_.empty() || projected <= options_.gradient_tolerance * J_.norm() * best_.r.norm();
  }

  /// Tries steps until one is accepted; true if there is no more to gain.
  bool improve() {
    Eigen::MatrixXd on_free(J_.rows(), static_cast<Eigen::Index>(free_.size()));
    for (std::size_t k = 0; k < free_.size(); ++k) on_free.col(static_cast<Eigen::Index>(k)) = J_.col(free_[k]);
    for (;;) {
      const Eigen::VectorXd step = step_of(on_free, best_.r, damping_, options_.rank_tolerance);
      Eigen::VectorXd trial = z_;
      for (std::size_t k = 0; k < free_.size(); ++k) trial[free_[k]] += step[static_cast<Eigen::Index>(k)];
      trial = trial.cwiseMax(0.0).cwiseMin(1.0);
      const double moved = (trial - z_).lpNorm<Eigen::Infinity>();
      const bool accepted = try_point(trial);
      if (moved <= options_.step_tolerance || damping_ > 1e12 || stalls_ == most_stalls) return true;
      if (accepted) return false;
    }
  }

 private:
  static constexpr int most_stalls = 3;

  Eigen::VectorXd x_of(const Eigen::VectorXd& z) const {
    return (problem_.lower + width_.cwiseProduct(z)).cwiseMax(problem_.lower).cwiseMin(problem_.upper);
  }

  /// Moves there if it is no worse, and adapts the damping.
  bool try_point(const Eigen::VectorXd& trial) {
    const double expected = best_.cost - 0.5 * (best_.r + J_ * (trial - z_)).squaredNorm();
    LeastSquaresResult next{.x = x_of(trial)};
    const bool valid = problem_.evaluate(next.x, next.r, &next.J);
    next.cost = valid ? 0.5 * next.r.squaredNorm() : std::numeric_limits<double>::infinity();
    if (!(next.cost <= best_.cost)) {
      damping_ = std::max(10.0 * damping_, least_damping);
      return false;
    }
    const double gain = expected > 0.0 ? (best_.cost - next.cost) / expected : 0.0;
    stalls_ = best_.cost - next.cost < options_.stall_decrease * best_.cost ? stalls_ + 1 : 0;
    next.iterations = best_.iterations;
    best_ = std::move(next);
    z_ = trial;
    if (gain > 0.75) {
      damping_ = damping_ < 0.01 * least_damping ? 0.0 : 0.1 * damping_;
    } else if (gain <= 0.25) {
      damping_ = std::max(4.0 * damping_, least_damping);
    }
    return true;
  }

  static constexpr double least_damping = 1e-6;

  const LeastSquaresProblem& problem_;
  const LeastSquaresOptions& options_;
  Eigen::VectorXd width_;
  Eigen::VectorXd z_;
  LeastSquaresResult best_;
  Eigen::MatrixXd J_;  // by z
  std::vector<Eigen::Index> free_;
  double damping_ = 0.0;
  int stalls_ = 0;
};

}  // namespace

LeastSquaresResult minimise(const LeastSquaresProblem& problem, const Eigen::VectorXd& x0,
                            const LeastSquaresOptions& options,
                            const std::function<bool(int iteration, double cost)>& watch) {
  Search search(problem, x0, options);
  LeastSquaresResult& best = search.best();
  if (!search.begin()) {
    best.end = LeastSquaresEnd::cannot_evaluate;
    return std::move(best);
  }
  for (bool done = false; !done && best.iterations < options.max_iterations;) {
    if (watch && !watch(best.iterations, best.cost)) {
      best.end = LeastSquaresEnd::interrupted;
      break;
    }
    done = search.is_stationary();
    if (!done) {
      done = search.improve();
      ++best.iterations;
    }
    if (done) best.end = LeastSquaresEnd::converged;
  }
  return std::move(best);
}

}  // namespace muldi::math
