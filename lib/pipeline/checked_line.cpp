#include "pipeline/checked_line.hpp"

#include <algorithm>
#include <cmath>

#include "math/derivative_check.hpp"

namespace muldi::pipeline {
namespace {

constexpr double error_limit = 1e-6;

}  // namespace

CheckedDerivative checked_line(std::string of, const std::function<Eigen::VectorXd(double)>& f,
                               const Eigen::VectorXd& given) {
  const math::VectorFunction line = [&](const Eigen::VectorXd& s) { return f(s[0]); };
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(1);
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  const math::DerivativeError error = math::derivative_error(given, math::difference_jacobian(line, zero, one));
  const math::TaylorTest taylor = math::taylor_test(line, {given}, {.x = zero, .direction = one, .first_step = 1.0});
  // What is below the round-off of the function is nothing.
  const double least = 1e-9 * f(0.0).lpNorm<Eigen::Infinity>();
  const bool nothing =
      given.lpNorm<Eigen::Infinity>() <= least && std::max(std::abs(error.given), std::abs(error.expected)) <= least;
  return {.of = std::move(of),
          .error = nothing ? 0.0 : error.relative,
          .slope = taylor.slope,
          .expected = 2.0,
          .passed = nothing || error.relative < error_limit};
}

}  // namespace muldi::pipeline
