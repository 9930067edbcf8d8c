#include "math/derivative_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/error.hpp"

namespace muldi::math {
namespace {

double largest(const Eigen::MatrixXd& matrix) { return matrix.size() == 0 ? 0.0 : matrix.cwiseAbs().maxCoeff(); }

/// Slope of the least-squares line through (x, y).
double line_slope(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    mean_x += x[k] / n;
    mean_y += y[k] / n;
  }
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += (x[k] - mean_x) * (x[k] - mean_x);
    xy += (x[k] - mean_x) * (y[k] - mean_y);
  }
  return xy / xx;
}

}  // namespace

DerivativeError derivative_error(const Eigen::MatrixXd& given, const Eigen::MatrixXd& expected) {
  MULDI_EXPECT(given.rows() == expected.rows() && given.cols() == expected.cols(), "the shapes differ");
  DerivativeError worst;
  if (given.size() == 0) return worst;
  const double scale = std::max(largest(given), largest(expected));
  double difference = -1.0;
  for (Eigen::Index i = 0; i < given.rows(); ++i) {
    for (Eigen::Index j = 0; j < given.cols(); ++j) {
      const double here = std::abs(given(i, j) - expected(i, j));
      if (here <= difference) continue;
      difference = here;
      worst = {.row = i, .column = j, .given = given(i, j), .expected = expected(i, j)};
      if (std::isnan(here)) {
        worst.relative = here;
        return worst;
      }
    }
  }
  worst.relative = scale > 0.0 ? difference / scale : 0.0;
  return worst;
}

Eigen::MatrixXd difference_jacobian(const VectorFunction& f, const Eigen::VectorXd& x, const Eigen::VectorXd& h) {
  MULDI_EXPECT(h.size() == x.size(), "one step a variable");
  Eigen::MatrixXd jacobian;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const auto central = [&](double step) -> Eigen::VectorXd {
      Eigen::VectorXd up = x;
      Eigen::VectorXd down = x;
      up[j] += step;
      down[j] -= step;
      // The steps that were really taken, after rounding.
      return (f(up) - f(down)) / (up[j] - down[j]);
    };
    const Eigen::VectorXd d1 = central(h[j]);
    const Eigen::VectorXd d2 = central(0.5 * h[j]);
    const Eigen::VectorXd d4 = central(0.25 * h[j]);
    const Eigen::VectorXd e1 = (4.0 * d2 - d1) / 3.0;
    const Eigen::VectorXd e2 = (4.0 * d4 - d2) / 3.0;
    if (j == 0) jacobian.resize(d1.size(), x.size());
    jacobian.col(j) = (16.0 * e2 - e1) / 15.0;
  }
  return jacobian;
}

TaylorTest taylor_test(const VectorFunction& f, const std::vector<Eigen::VectorXd>& derivatives,
                       const TaylorSetup& setup) {
  TaylorTest test;
  const Eigen::VectorXd f0 = f(setup.x);
  std::vector<double> log_step;
  std::vector<double> log_remainder;
  double h = setup.first_step;
  for (int k = 0; k < setup.n_steps; ++k, h *= 0.5) {
    const Eigen::VectorXd f1 = f(setup.x + h * setup.direction);
    Eigen::VectorXd remainder = f1 - f0;
    double factor = 1.0;
    const double size = std::max(largest(f0), largest(f1));
    for (std::size_t order = 0; order < derivatives.size(); ++order) {
      factor *= h / static_cast<double>(order + 1);
      remainder -= factor * derivatives[order];
    }
    const double error = remainder.norm();
    test.step.push_back(h);
    test.remainder.push_back(error);
    // Within a thousand roundings of the values the noise would bend the slope.
    if (error > 1000.0 * std::numeric_limits<double>::epsilon() * size || std::isnan(error)) {
      log_step.push_back(std::log(h));
      log_remainder.push_back(std::log(error));
    }
  }
  if (log_step.size() < 2) {
    test.slope = std::numeric_limits<double>::infinity();
    return test;
  }
  // A small error of a derivative shows at the finest steps only.
  const std::size_t n = std::min<std::size_t>(3, log_step.size());
  const auto finest = [n](const std::vector<double>& all) {
    return std::vector<double>(all.end() - static_cast<std::ptrdiff_t>(n), all.end());
  };
  test.slope = line_slope(finest(log_step), finest(log_remainder));
  return test;
}

}  // namespace muldi::math
