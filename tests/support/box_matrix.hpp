#pragma once
/// Matrices of finite elements on a box, for the tests and benchmarks of the sparse solvers: trilinear elasticity,
/// nearly incompressible or not, a Laplacian for a fourth unknown of each node, a weak coupling, a mass.
#include <Eigen/SparseCore>
#include <array>
#include <utility>
#include <vector>

#include "math/sparse_block_matrix.hpp"
#include "math/sparse_block_pattern.hpp"

namespace muldi::test {

/// Cells are unit cubes; the shear modulus is 1.
struct BoxProblem {
  std::array<int, 3> cells{1, 1, 1};
  int block_size = 4;          ///< 3: displacement; 4: displacement and potential
  double bulk_modulus = 10.0;  ///< volumetric stiffness, at the cell's middle as in mean dilatation
  double potential_sign = -1;  ///< -1: physical permittivity, quasi-definite; +1: positive definite
  double permittivity = 1.0;   ///< of the Laplacian
  double coupling = 0.1;       ///< piezoelectric-like, between displacement and potential
  double mass = 0.0;           ///< consistent mass of the displacement, per volume (rho / dt^2)
  int fixed_ends = 1;          ///< all unknowns fixed at the bottom (1), at bottom and top (2), nowhere (0)
};

/// Nodes of the box, x fastest.
int n_box_nodes(std::array<int, 3> cells);
std::vector<std::array<int, 8>> box_cells(std::array<int, 3> cells);
math::SymmetricBlockPattern box_pattern(const BoxProblem& problem);
math::NodeMask box_mask(const BoxProblem& problem);
/// The assembled matrix, not constrained.
math::SymmetricBlockMatrix box_matrix(const BoxProblem& problem, const math::SymmetricBlockPattern& pattern);
/// Both triangles, without the constrained unknowns, numbered as before.
Eigen::SparseMatrix<double> free_part(const math::SymmetricBlockMatrix& matrix, const math::NodeMask& mask);

}  // namespace muldi::test
