#pragma once
/// The step that the solids of a model allow, for messages.
#include <Eigen/Core>
#include <string>

#include "build/built_model.hpp"

namespace muldi::build {

struct StableStep {
  std::string name = {};  ///< solid, and its cell that bounds it; empty if none does
  double step = 0.0;
  double length = 0.0;
  double stress = 0.0;
};

/// See fem::exceeded_bound: of the solid or meshed muscle that allows the least step below `dt`, at q (n_q) with the
/// stage unknowns y (n_y).
StableStep exceeded_step(const BuiltModel& built, const Eigen::VectorXd& q, const Eigen::VectorXd& y, double dt);

}  // namespace muldi::build
