#pragma once
/// The thesis's update with redundant unknowns (numerics 1.8 i): the referee of the update on the manifold.
#include <memory>

#include "support/rigid_system.hpp"

namespace muldi::test {

/// Unknown q_{n+1} (12 a body) and mu, Z mu = dt lambda (loop rows), rows
///     T(q_n)^T [ p_n + dt/2 F - pi - G_c(q_n)^T Z mu ] = 0,  g(q_{n+1}) = 0
/// with all g: directors, tree joints, Z^T g_c of the loop rows. Forces Q on joint coordinates are taken as
/// dt/2 Q grad theta(q) at either end, with theta(q) of numerics 1.7. One dense matrix, plain Newton.
class RedundantUpdate {
 public:
  RedundantUpdate(const model::Model& model, double dt);

  /// Moves (q, p) one step on; returns the number of Newton iterations, -1 if there is no convergence.
  /// Angles of joints with forces on them must stay in (-pi, pi).
  int advance(Eigen::VectorXd& q, Eigen::VectorXd& p, std::span<const double> u) const;

 private:
  /// A joint coordinate, with its places in x and in the minimal rates.
  struct ScalarCoordinate {
    multibody::JointCoordinate theta;
    Eigen::Index coordinate;
    Eigen::Index rate;
  };

  /// Coordinates x of q, angles in (-pi, pi]; those of balls stay zero.
  Eigen::VectorXd coordinates(const Eigen::VectorXd& q) const;
  /// grad theta(q) of every minimal rate, as columns; zero for balls (n_q, n_v).
  Eigen::MatrixXd gradients(const Eigen::VectorXd& q) const;

  const model::Model& model_;
  const multibody::TreeManifold& manifold_;
  double dt_;
  std::vector<ScalarCoordinate> scalars_;
};

}  // namespace muldi::test
