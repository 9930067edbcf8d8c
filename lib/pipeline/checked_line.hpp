#pragma once
/// One derivative along a direction against differences.
#include <Eigen/Core>
#include <functional>
#include <string>

#include "pipeline/check_derivatives.hpp"

namespace muldi::pipeline {

/// A function along a line s -> f(s) with its given derivative at s = 0; s = 1 is the longest step of the differences.
CheckedDerivative checked_line(std::string of, const std::function<Eigen::VectorXd(double)>& f,
                               const Eigen::VectorXd& given);

}  // namespace muldi::pipeline
