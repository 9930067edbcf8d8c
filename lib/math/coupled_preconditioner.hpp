#pragma once
/// The preconditioner of large dynamic problems: Chebyshev for the displacement, multigrid for the potential.
#include <Eigen/Core>
#include <optional>

#include "math/aggregation_multigrid.hpp"
#include "math/block_chebyshev.hpp"

namespace muldi::math {

/// Which sign the potential's part of the preconditioner has.
enum class PotentialSign {
  positive,      ///< a positive definite preconditioner: for conjugate gradients and MINRES
  of_the_matrix  ///< for GMRES: eigenvalues near one although the matrix is indefinite, half the iterations of MINRES
};

/// Block-diagonal P ~ A^-1 for matrices with three displacements and at most one potential at each node, whose
/// constrained rows are those of the identity. The coupling of the two parts is left to the iteration.
class CoupledPreconditioner {
 public:
  /// `degrees` of the Chebyshev polynomial. The pattern must outlive the object.
  explicit CoupledPreconditioner(const SymmetricBlockPattern& pattern, BlockChebyshev::Degrees degrees = {});

  /// Takes a new matrix. The multigrid is set up at the first time and when `new_potential` is set: it serves until the
  /// permittivity or the shape of the mesh changes much. False: the displacement part is not positive definite.
  bool update(const SymmetricBlockMatrix& matrix, bool new_potential = false);
  /// z = P r
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z, PotentialSign sign = PotentialSign::positive);

  const BlockChebyshev& displacement() const { return displacement_; }
  /// Nothing if there is no potential.
  const std::optional<AggregationMultigrid>& potential() const { return potential_; }
  /// -1 if the potential's part of the matrix is negative definite.
  double potential_sign() const { return sign_; }

 private:
  void set_up_potential(const SymmetricBlockMatrix& matrix);

  int block_size_;
  BlockChebyshev displacement_;
  std::optional<AggregationMultigrid> potential_;
  double sign_ = 1.0;
  Eigen::VectorXf r_, z_;
  Eigen::VectorXf row_signs_;  // of the potential's diagonal
};

}  // namespace muldi::math
