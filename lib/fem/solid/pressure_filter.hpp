#pragma once
/// Element pressures that exert no force on a solid, and their removal (numerics C4b).
///
/// Where a regular mesh is held on its walls, checkerboards of pressures and those that follow from them exert no force
/// at the reference. As multipliers of exact incompressibility they are not determined there, and once the solid moves
/// no force at the begin of a step can keep the volumes that belong to them. Filtered: the pressures have no part of
/// them, and the volumes of cells are kept but for these patterns; volumes of groups of cells over which a pattern sums
/// to zero are kept exactly.
#include <Eigen/Core>

#include "fem/solid/bonds.hpp"
#include "fem/solid/element_set.hpp"
#include "fem/solid/solid_unknowns.hpp"

namespace muldi::fem {

class PressureFilter {
 public:
  /// Beyond, the patterns are not looked for: they would take as long as the solution.
  static constexpr int most_cells = 60000;

  /// Without any pattern.
  PressureFilter() = default;
  /// Found at the reference configuration.
  PressureFilter(const ElementSet& elements, const SolidUnknowns& unknowns, const Bonds& bonds);

  /// Patterns without force, a constant one included.
  Eigen::Index n_patterns() const { return patterns_.cols(); }
  /// Removes the patterns from pressures (n_cells), orthogonally in the volume.
  void keep_pressures(Eigen::Ref<Eigen::VectorXd> p) const;
  /// Removes what belongs to the patterns from rows of volumes V_e (J_e - 1) (n_cells).
  void keep_rows(Eigen::Ref<Eigen::VectorXd> rows) const;
  /// out += factor V N N^T V p, N the patterns, N^T V N = 1.
  void add_patterns(double factor, const Eigen::VectorXd& p, Eigen::VectorXd& out) const;

 private:
  Eigen::VectorXd volumes_;
  Eigen::MatrixXd patterns_;  // N, one a column
  mutable Eigen::VectorXd parts_;
};

}  // namespace muldi::fem
