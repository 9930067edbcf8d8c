#pragma once
/// Where the solids of a model are squeezed most, for messages.
#include <Eigen/Core>
#include <string>

#include "build/built_model.hpp"

namespace muldi::build {

struct SqueezedCell {
  std::string name = {};  ///< number, place and solid; empty without solids
  double stretch = 0.0;   ///< its least principal stretch
};

/// The cell with the least principal stretch of all solids and meshed muscles at a configuration q (n_q).
SqueezedCell squeezed_cell(const BuiltModel& built, const Eigen::VectorXd& q);

}  // namespace muldi::build
