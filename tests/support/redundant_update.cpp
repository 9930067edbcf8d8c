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
    : model_(model), manifold_(manifold_of(model)), dt_(dt) {
  const multibody::KinematicTree& tree = manifold_.tree();
  for (const multibody::TreeLink& link : tree.links) {
    Eigen::Index coordinate = link.first_coordinate;
    Eigen::Index rate = link.first_rate;
    for (const multibody::Motion& motion : tree.joint(link).pattern.motions) {
      if (motion.kind != multibody::Motion::Kind::ball) {
        scalars_.push_back({multibody::JointCoordinate(tree.joint(link), motion), coordinate, rate});
      }
      coordinate += motion.n_coordinates();
      rate += motion.n_rates();
    }
  }
}

VectorXd RedundantUpdate::coordinates(const VectorXd& q) const {
  VectorXd x = VectorXd::Zero(manifold_.n_x());
  for (const ScalarCoordinate& scalar : scalars_) x[scalar.coordinate] = scalar.theta.value(q);
  return x;
}

MatrixXd RedundantUpdate::gradients(const VectorXd& q) const {
  MatrixXd result = MatrixXd::Zero(manifold_.n_q(), manifold_.n_v());
  VectorXd gradient(manifold_.n_q());
  for (const ScalarCoordinate& scalar : scalars_) {
    gradient.setZero();
    scalar.theta.add_gradient(q, 1.0, gradient);
    result.col(scalar.rate) = gradient;
  }
  return result;
}

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
  forces.on_rates = VectorXd::Zero(n_v);
  forces.begin = forces.end = VectorXd::Zero(n_q);
  VectorXd diagonal = VectorXd::Zero(n_v);
  const VectorXd x0 = coordinates(q0);
  const MatrixXd begin = gradients(q0);
  VectorXd mu = VectorXd::Zero(n_c);
  double previous = 0.0;
  for (int iteration = 1; iteration <= 30; ++iteration) {
    const VectorXd middle = 0.5 * (q0 + q);
    const VectorXd v = (q - q0) / dt_;
    const VectorXd x1 = coordinates(q);
    const auto n_x = static_cast<std::size_t>(x0.size());
    const model::IntervalPoint at{
        .q0 = q0, .q1 = q, .q = middle, .v = v, .u = u, .dt = dt_, .x0 = {x0.data(), n_x}, .x1 = {x1.data(), n_x}};
    model_.forces(at, forces);
    model_.tangent(at, model::TangentWeights::step(dt_), K);
    model_.rate_tangent(at, model::TangentWeights::step(dt_), diagonal);
    const VectorXd bracket = p + 0.5 * dt_ * (forces.force + begin * forces.on_rates) - forces.momentum + forces.begin;
    VectorXd residual(n_v + n_g);
    residual.head(n_v) = T.transpose() * (bracket - G_c.transpose() * mu);
    residual.segment(n_v, n_tree) = -values(manifold_.tree_rows(), q);
    residual.tail(n_c) = -Z.transpose() * values(manifold_.loop_rows(), q);
    MatrixXd matrix = MatrixXd::Zero(n_q + n_c, n_q + n_c);
    matrix.topLeftCorner(n_v, n_q) =
        T.transpose() * (K.dense() + begin * diagonal.asDiagonal() * gradients(q).transpose());
    matrix.topRightCorner(n_v, n_c) = (G_c * T).transpose();
    matrix.block(n_v, 0, n_tree, n_q) = dense_jacobian(manifold_.tree_rows(), q);
    matrix.bottomLeftCorner(n_c, n_q) = Z.transpose() * dense_jacobian(manifold_.loop_rows(), q);
    const VectorXd increment = matrix.fullPivLu().solve(residual);
    q += increment.head(n_q);
    mu += increment.tail(n_c);
    const double size = increment.head(n_q).lpNorm<Eigen::Infinity>() / q.lpNorm<Eigen::Infinity>();
    if (size < 1e-13 || (iteration > 3 && size < 1e-11 && size > 0.5 * previous)) {
      p = forces.momentum + 0.5 * dt_ * (forces.force + gradients(q) * forces.on_rates) + forces.end;
      return iteration;
    }
    previous = size;
  }
  return -1;
}

}  // namespace muldi::test
