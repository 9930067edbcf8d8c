#pragma once
/// The thesis's update with redundant unknowns (numerics 1.8 i): the referee of the update on the manifold.
#include <memory>

#include "support/rigid_system.hpp"

namespace muldi::test {

/// Unknown q_{n+1} (12 a body) and mu, Z mu = dt lambda (loop rows), rows
///     T(q_n)^T [ p_n + dt/2 F - pi - G_c(q_n)^T Z mu ] = 0,  g(q_{n+1}) = 0
/// with all g: directors, tree joints, Z^T g_c of the loop rows. One dense matrix, plain Newton.
class RedundantUpdate {
 public:
  RedundantUpdate(const model::Model& model, double dt);

  /// Moves (q, p) one step on; returns the number of Newton iterations, -1 if there is no convergence.
  int advance(Eigen::VectorXd& q, Eigen::VectorXd& p, std::span<const double> u) const;

 private:
  const model::Model& model_;
  const multibody::TreeManifold& manifold_;
  double dt_;
};

}  // namespace muldi::test
