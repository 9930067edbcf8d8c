#include "support/redundant_update.hpp"

#include <Eigen/LU>

namespace muldi::test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

VectorXd values(const std::vector<model::Bilinear>& rows, const VectorXd& q) {
  VectorXd g(static_cast<Eigen::Index>(rows.size()));
  for (Eigen::Index i = 0; i < g.size(); ++i) g[i] = rows[static_cast<std::size_t>(i)].value(q);
  return g;
}

}  // namespace

RedundantUpdate::RedundantUpdate(const model::Model& model, double dt)
    : model_(model), manifold_(manifold_of(model)), dt_(dt) {}

int RedundantUpdate::advance(VectorXd& q, VectorXd& p, std::span<const double> u) const {
  const VectorXd q0 = q;
  const auto n_q = static_cast<Eigen::Index>(manifold_.n_q());
  const auto n_v = static_cast<Eigen::Index>(manifold_.n_v());
  const auto n_c = static_cast<Eigen::Index>(manifold_.n_c());
  // The frame comes from the configuration alone.
  const auto frame = manifold_.make_frame();
  manifold_.update(VectorXd(), q0, *frame);
  MatrixXd T(n_q, n_v);
  VectorXd dq = VectorXd::Zero(n_q);
  for (Eigen::Index k = 0; k < n_v; ++k) {
    manifold_.lift(*frame, VectorXd::Unit(n_v, k), dq);
    T.col(k) = dq;
  }
  manifold_.choose_loop_rows(*frame);
  const MatrixXd Z = manifold_.loop_basis(*frame);
  const MatrixXd G_c = Z.transpose() * dense_jacobian(manifold_.loop_rows(), q0);
  const auto n_tree = static_cast<Eigen::Index>(manifold_.tree_rows().size());
  const Eigen::Index n_g = n_tree + n_c;
  math::BlockMatrix K(*model_.pattern);
  model::IntervalForces forces{VectorXd::Zero(n_q), VectorXd::Zero(n_q)};
  VectorXd mu = VectorXd::Zero(n_c);
  double previous = 0.0;
  for (int iteration = 1; iteration <= 30; ++iteration) {
    const VectorXd middle = 0.5 * (q0 + q);
    const VectorXd v = (q - q0) / dt_;
    const model::IntervalPoint at{.q0 = q0, .q1 = q, .q = middle, .v = v, .u = u, .dt = dt_};
    model_.forces(at, forces);
    model_.tangent(at, model::TangentWeights::step(dt_), K);
    VectorXd residual(n_v + n_g);
    residual.head(n_v) = T.transpose() * (p + 0.5 * dt_ * forces.force - forces.momentum - G_c.transpose() * mu);
    residual.segment(n_v, n_tree) = -values(manifold_.tree_rows(), q);
    residual.tail(n_c) = -Z.transpose() * values(manifold_.loop_rows(), q);
    MatrixXd matrix = MatrixXd::Zero(n_q + n_c, n_q + n_c);
    matrix.topLeftCorner(n_v, n_q) = T.transpose() * K.dense();
    matrix.topRightCorner(n_v, n_c) = (G_c * T).transpose();
    matrix.block(n_v, 0, n_tree, n_q) = dense_jacobian(manifold_.tree_rows(), q);
    matrix.bottomLeftCorner(n_c, n_q) = Z.transpose() * dense_jacobian(manifold_.loop_rows(), q);
    const VectorXd increment = matrix.fullPivLu().solve(residual);
    q += increment.head(n_q);
    mu += increment.tail(n_c);
    const double size = increment.head(n_q).lpNorm<Eigen::Infinity>() / q.lpNorm<Eigen::Infinity>();
    if (size < 1e-13 || (iteration > 3 && size < 1e-11 && size > 0.5 * previous)) {
      p = forces.momentum + 0.5 * dt_ * forces.force;
      return iteration;
    }
    previous = size;
  }
  return -1;
}

}  // namespace muldi::test
