#pragma once
/// The strongest true field in every cell of a solid.
#include <Eigen/Core>

#include "fem/solid/element_set.hpp"

namespace muldi::fem {

/// The largest |e| at the eight Gauss points of each cell, e = -dphi/dx the field in the deformed material.
///
/// x: positions (3 n_nodes); phi: potentials (n_nodes); peaks: overwritten (n_cells), field. Requests no memory; the
/// same bits for any number of threads. Source: numerics 1.1, with derivatives by reference coordinates in both
/// gradients.
void field_peaks(const ElementSet& elements, const Eigen::Ref<const Eigen::VectorXd>& x,
                 const Eigen::Ref<const Eigen::VectorXd>& phi, Eigen::Ref<Eigen::VectorXd> peaks);

}  // namespace muldi::fem
