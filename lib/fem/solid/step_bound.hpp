#pragma once
/// The step up to which pressures that act at nodes in time are stable (lib/THEORY.md, 9).
#include <Eigen/Core>
#include <limits>

#include "fem/solid/solid.hpp"

namespace muldi::fem {

struct StepBound {
  int cell = -1;  ///< none: no cell bounds the step
  double step = std::numeric_limits<double>::infinity();
  double length = 0.0;  ///< the shortest edge of the cell, or the thickness of the solid
  double stress = 0.0;  ///< that bounds it with this length, the density and step^2 = length^2 density / stress
};

/// About the largest stable step of a solid whose cells keep their volume as a whole, if `dt` is beyond it, otherwise
/// none.
///
/// The least h sqrt(rho/|p|) of the cells; where viscosity brakes what grows from cell to cell, that of the thickness
/// of the solid and its mean stress. q: configuration (n_q); y: stage unknowns (n_y) of the interval that begins there.
StepBound exceeded_bound(const Solid& solid, const Eigen::VectorXd& q, const Eigen::VectorXd& y, double dt);

}  // namespace muldi::fem
