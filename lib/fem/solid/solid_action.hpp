#pragma once
/// The exact derivative of a solid's equations, applied to an increment: nothing is lagged, made symmetric or left out.
#include <Eigen/Core>
#include <vector>

#include "fem/solid/solid.hpp"

namespace muldi::fem {

/// An increment of a solid's unknowns, or residual rows that belong to them.
struct SolidVector {
  Eigen::VectorXd x = {};    ///< positions, rows of the momentum balance (3 n_nodes)
  Eigen::VectorXd phi = {};  ///< potentials, charges (n_nodes)
  Eigen::VectorXd p = {};    ///< element pressures, volumes (n_pressures)

  explicit SolidVector(const Solid& solid)
      : x(Eigen::VectorXd::Zero(3 * solid.elements().n_nodes())),
        phi(Eigen::VectorXd::Zero(solid.elements().n_nodes())),
        p(Eigen::VectorXd::Zero(solid.n_pressures())) {}
};

class SolidAction {
 public:
  /// The solid must outlive the object.
  explicit SolidAction(const Solid& solid);

  /// Where the equations of a step (dt > 0) or of rest (dt = 0) are linearised; copies what it needs.
  void linearise(const model::IntervalPoint& at);
  /// out = minus the derivative of the residual rows (momentum balance, stage rows) along d.
  void apply(const SolidVector& d, SolidVector& out);

 private:
  const Solid& solid_;
  double dt_ = 0.0;
  double coupling_ = 0.0;  // c of the volume rows
  bool moves_ = false;
  std::vector<double> u_;
  Eigen::VectorXd x_, v_, phi_, p_;  // of the evaluation
  Volumes begin_, end_;              // of pressure forces, of volume rows
  Eigen::VectorXd compliance_;       // D_e of the volume rows
  Eigen::VectorXd dx_, dv_, force_, momentum_, weight_;
};

}  // namespace muldi::fem
