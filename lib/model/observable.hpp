#pragma once
/// Quantities that a run records at the nodes in time: joint angles, muscle lengths, points, energies.
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/describe.hpp"

namespace muldi::model {

/// The complete state at a node in time, as observables see it.
struct NodeView {
  long serial = 0;  ///< differs from view to view, so that values for several series are computed once
  double t = 0.0;
  const Eigen::VectorXd& x;                 ///< coordinates of the manifold (n_x)
  const Eigen::VectorXd& rate;              ///< minimal velocities (n_v), from the momenta by the mass matrix
  const Eigen::VectorXd& q;                 ///< configuration (n_q)
  const Eigen::VectorXd& v;                 ///< T rate (n_q)
  const Eigen::VectorXd& constraint_force;  ///< -G^T lambda on the right of the equation of motion (n_q)
  const Eigen::VectorXd& multipliers;       ///< lambda of the loop rows (n_loop_rows), of least norm
  const Eigen::VectorXd& y;                 ///< stage unknowns of the interval that ends here (n_y)
  std::span<const double> u;                ///< controls of the interval that ends here (at t_0: of the first)
  /// Stage unknowns of the interval that begins here (n_y), of which the multipliers belong to this node; null: y.
  const Eigen::VectorXd* y_after = nullptr;
  /// Accounts of the electric sources (model/supply.hpp), one a terminal; empty where none are kept.
  std::span<const double> accounts = {};
};

/// One recorded series: a fixed number of doubles a row.
struct Observable {
  std::string path;                ///< path in the result file, e.g. "muscles/upper/length"
  std::vector<std::size_t> shape;  ///< {} scalar, {3}, {3, 3} ...
  base::Dimension unit;
  std::string doc;
  /// Writes the row; on entry `out` holds the previous row of the series (zeros before the first).
  std::function<void(const NodeView&, std::span<double> out)> evaluate;

  bool of_motion = false;  ///< zero at rest: not recorded in statics

  std::size_t size() const {
    std::size_t n = 1;
    for (const std::size_t extent : shape) n *= extent;
    return n;
  }
};

/// A limit of a material that no state of a run may pass.
struct Guard {
  /// What is passed where, at a node in time; empty where nothing is.
  std::function<std::string(const NodeView&)> breach;
};

/// Fields over a mesh, recorded in a series of their own.
struct FieldHistory {
  struct Field {
    Observable observable;  ///< its path is below `folder`
    bool at_nodes = false;  ///< else one value a cell
  };

  std::string folder;                    ///< e.g. "solids/cube"
  int every = 1;                         ///< records of the run between records of the fields
  std::vector<double> reference = {};    ///< positions of the nodes (3 n_nodes)
  std::vector<std::int64_t> cells = {};  ///< nodes of the hexahedra (8 n_cells), in VTK's order
  std::vector<Field> fields = {};
};

}  // namespace muldi::model
