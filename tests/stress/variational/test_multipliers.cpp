/// The step with multipliers for every constraint, one dense augmented system, against that on the manifold (numerics
/// 1.5, 5 no. 19).
#include <gtest/gtest.h>

#include <Eigen/QR>

#include "support/figure.hpp"
#include "support/linkages.hpp"
#include "support/systems.hpp"
#include "variational/stepper.hpp"

namespace muldi::variational {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// p_n + dt/2 F - pi - G(q_n)^T mu = 0, g(q_{n+1}) = 0 with the rows of all bodies, joints and loops; rows that depend
/// on each other get the multipliers of least norm. No null space, no coordinates, no forces in joints.
class AugmentedUpdate {
 public:
  AugmentedUpdate(const model::Model& model, double dt) : model_(model), dt_(dt) {
    const multibody::TreeManifold& manifold = test::manifold_of(model);
    rows_ = manifold.tree_rows();
    rows_.insert(rows_.end(), manifold.loop_rows().begin(), manifold.loop_rows().end());
  }

  bool advance(VectorXd& q, VectorXd& p, std::span<const double> u) const {
    const VectorXd q0 = q;
    const Eigen::Index n = q.size();
    const auto n_rows = static_cast<Eigen::Index>(rows_.size());
    const MatrixXd G0 = test::dense_jacobian(rows_, q0);
    math::BlockMatrix K(*model_.pattern);
    model::IntervalForces forces{VectorXd::Zero(n), VectorXd::Zero(n)};
    VectorXd mu = VectorXd::Zero(n_rows);
    for (int iteration = 0; iteration < 20; ++iteration) {
      const VectorXd middle = 0.5 * (q0 + q);
      const VectorXd v = (q - q0) / dt_;
      const model::IntervalPoint at{.q0 = q0, .q1 = q, .q = middle, .v = v, .u = u, .dt = dt_};
      model_.forces(at, forces);
      model_.tangent(at, model::TangentWeights::step(dt_), K);
      MatrixXd matrix = MatrixXd::Zero(n + n_rows, n + n_rows);
      matrix.topLeftCorner(n, n) = K.dense();
      matrix.topRightCorner(n, n_rows) = G0.transpose();
      matrix.bottomLeftCorner(n_rows, n) = test::dense_jacobian(rows_, q);
      VectorXd residual(n + n_rows);
      residual.head(n) = p + 0.5 * dt_ * forces.force - forces.momentum - G0.transpose() * mu;
      for (Eigen::Index i = 0; i < n_rows; ++i) residual[n + i] = -rows_[static_cast<std::size_t>(i)].value(q);
      const VectorXd increment = matrix.completeOrthogonalDecomposition().solve(residual);
      q += increment.head(n);
      mu += increment.tail(n_rows);
      if (increment.head(n).lpNorm<Eigen::Infinity>() < 1e-11 * q.lpNorm<Eigen::Infinity>()) {
        p = forces.momentum + 0.5 * dt_ * forces.force;
        return true;
      }
    }
    return false;
  }

 private:
  const model::Model& model_;
  double dt_;
  std::vector<model::Bilinear> rows_;
};

void expect_same(const std::string& name, const test::RigidSystem& system, double dt, int steps) {
  const auto model = test::make_model(system);
  Stepper stepper(*model, dt, {.tolerance = 1e-12});
  const AugmentedUpdate augmented(*model, dt);
  State state = test::state_at_rest(*model);
  VectorXd q = state.q;
  VectorXd p = state.p;
  std::vector<double> u(model->controls.size());
  model->evaluate_controls(0.0, u);
  double largest = 0.0;
  for (int n = 0; n < steps; ++n) {
    ASSERT_EQ(stepper.advance(state, u).status, Status::running);
    ASSERT_TRUE(augmented.advance(q, p, u)) << "step " << n;
    largest = std::max(largest, (q - state.q).lpNorm<Eigen::Infinity>() / system.length);
  }
  EXPECT_GT((q - test::state_at_rest(*model).q).lpNorm<Eigen::Infinity>(), 1e-3 * system.length) << "it moves";
  test::record_figure("19", name + ", multipliers for all constraints against none, over the size", largest, 1e-8);
}

TEST(Multipliers, ForAllConstraintsGiveTheSameMotion) {
  expect_same("double pendulum", test::double_pendulum(), 2.0, 200);
  expect_same("muscle joint", test::muscle_joint(3e4), 2.0, 200);
  expect_same("four-bar", test::four_bar({}, test::earth_gravity), 1.0, 200);
  expect_same("quick-return", test::quick_return(test::earth_gravity), 1.0, 200);
}

}  // namespace
}  // namespace muldi::variational
