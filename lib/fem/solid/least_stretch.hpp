#pragma once
/// Where a solid is squeezed most.
#include <Eigen/Core>

#include "fem/solid/element_set.hpp"

namespace muldi::fem {

struct CellStretch {
  int cell = 0;
  double stretch = 1.0;  ///< the least principal stretch at its Gauss points
};

/// The least principal stretch (singular value of F) at the Gauss points of each cell (n_cells), at positions x
/// (3 n_nodes).
Eigen::VectorXd least_stretches(const ElementSet& elements, const Eigen::Ref<const Eigen::VectorXd>& x);

/// The cell with the least principal stretch (singular value of F) of all Gauss points at positions x (3 n_nodes), the
/// first of equal ones.
CellStretch least_stretch(const ElementSet& elements, const Eigen::Ref<const Eigen::VectorXd>& x);

}  // namespace muldi::fem
