/// Inertia, gravity and loads of director bodies.
#include <gtest/gtest.h>

#include "math/rotation.hpp"
#include "support/random_tree.hpp"

namespace muldi::multibody {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// One free body in a random pose with a full inertia tensor.
struct Body {
  test::RigidSystem system;
  std::unique_ptr<model::Model> model;
  VectorXd q;
  Matrix3d inertia;  // world axes

  explicit Body(std::mt19937& random, std::vector<Load> loads = {}) {
    system.add_body(7.0, Vector3d::Zero(), test::random_pose(random, 50.0));
    const Matrix3d axes = test::random_rotation(random);
    system.bodies[0].inertia = axes * Vector3d(3.0, 4.0, 5.0).asDiagonal() * axes.transpose();
    system.gravity = Vector3d(0.1, -0.3, 0.2);
    system.loads = std::move(loads);
    model = test::make_model(system);
    q = test::configuration_at(*model->manifold, model->manifold->reference());
    const Matrix3d& R = system.poses[0].orientation;
    inertia = R * system.bodies[0].inertia * R.transpose();
  }

  /// Directors turn with omega, the centre moves with v.
  VectorXd velocity(const Vector3d& v, const Vector3d& omega) const {
    VectorXd result(12);
    result.head<3>() = v;
    for (int k = 1; k < 4; ++k) result.segment<3>(3 * k) = omega.cross(Vector3d(q.segment<3>(3 * k)));
    return result;
  }
};

const Vector3d v(0.3, -0.7, 0.2);
const Vector3d omega(0.5, 0.9, -0.4);

TEST(RigidBody, EulerTensorOfTable81) {
  // numerics 1.6: (15036, 2524, 14940) gives (1214, 13726, 1310).
  RigidBody body;
  body.inertia = Vector3d(15036.0, 2524.0, 14940.0).asDiagonal();
  EXPECT_EQ(body.euler_tensor().diagonal(), Vector3d(1214.0, 13726.0, 1310.0));
}

TEST(RigidBody, KineticEnergyIsThatOfTranslationAndRotation) {
  std::mt19937 random(40);
  for (int n = 0; n < 20; ++n) {
    const Body body(random);
    std::array<model::Energy, 1> energy{};
    const VectorXd rates = body.velocity(v, omega);
    body.model->energies({.x = {}, .q = body.q, .v = rates, .u = {}}, energy);
    EXPECT_NEAR(energy[0].kinetic, 3.5 * v.squaredNorm() + 0.5 * omega.dot(body.inertia * omega), 1e-14);
    EXPECT_NEAR(energy[0].gravity, -7.0 * body.system.gravity.dot(body.q.head<3>()), 1e-12);
  }
}

TEST(RigidBody, MassMatrixIsConstantAndGivesTheMomentum) {
  std::mt19937 random(41);
  const Body body(random);
  math::BlockMatrix M(*body.model->pattern);
  const VectorXd rates = test::random_entries(random, 12, 1.0);
  model::IntervalForces out{VectorXd(12), VectorXd(12)};
  Eigen::MatrixXd first;
  for (int n = 0; n < 3; ++n) {
    const VectorXd q = test::random_entries(random, 12, 10.0);
    const model::IntervalPoint at{.q0 = q, .q1 = q, .q = q, .v = rates, .u = {}, .dt = 0.1};
    body.model->tangent(at, model::TangentWeights::mass(), M);
    body.model->forces(at, out);
    if (n == 0) first = M.dense();
    EXPECT_EQ(M.dense(), first);
    EXPECT_LT((M.dense() * rates - out.momentum).norm(), 1e-14);
  }
  EXPECT_LT((first - first.transpose()).norm(), 1e-14);
}

TEST(RigidBody, MomentumMapsAreLinearAndAngularMomentum) {
  std::mt19937 random(42);
  const Body body(random);
  const VectorXd rates = body.velocity(v, omega);
  model::IntervalForces out{VectorXd(12), VectorXd(12)};
  body.model->forces({.q0 = body.q, .q1 = body.q, .q = body.q, .v = rates, .u = {}}, out);
  Vector3d linear;
  Vector3d angular;
  body.model->momentum_maps(body.q, out.momentum, linear, angular);
  EXPECT_LT((linear - 7.0 * v).norm(), 1e-14);
  EXPECT_LT((angular - 7.0 * body.q.head<3>().cross(v) - body.inertia * omega).norm(), 1e-12);
}

/// Force and moment about the centre of mass that a load gives, by its power on six motions.
Eigen::Matrix<double, 6, 1> wrench_of(const Body& body, std::span<const double> u) {
  Eigen::Matrix<double, 6, 1> wrench;
  const VectorXd zero = VectorXd::Zero(12);
  model::IntervalForces out{VectorXd(12), VectorXd(12)};
  body.model->forces({.q0 = body.q, .q1 = body.q, .q = body.q, .v = zero, .u = u}, out);
  out.force.head<3>() -= 7.0 * body.system.gravity;
  for (int k = 0; k < 3; ++k) {
    wrench[k] = out.force.dot(body.velocity(Vector3d::Unit(k), Vector3d::Zero()));
    wrench[3 + k] = out.force.dot(body.velocity(Vector3d::Zero(), Vector3d::Unit(k)));
  }
  return wrench;
}

TEST(Loads, ForcesAndTorquesAreTheirWrenches) {
  std::mt19937 random(43);
  const Vector3d point(3.0, -2.0, 5.0);
  const Vector3d direction(0.5, 0.2, -0.7);
  for (const Load::Frame frame : {Load::Frame::world, Load::Frame::body}) {
    for (const Load::Kind kind : {Load::Kind::force, Load::Kind::torque}) {
      const Body body(random, {{.name = "l",
                                .kind = kind,
                                .frame = frame,
                                .point = point,
                                .direction = direction,
                                .control = 1,
                                .control_factor = 2.0}});
      const Matrix3d& R = body.system.poses[0].orientation;
      const Vector3d along = 2.0 * 4.0 * (frame == Load::Frame::world ? direction : Vector3d(R * direction));
      Eigen::Matrix<double, 6, 1> expected;
      if (kind == Load::Kind::force) {
        expected << along, (R * point).cross(along);
      } else {
        expected << Vector3d::Zero(), along;
      }
      const std::array<double, 2> u{100.0, 4.0};
      EXPECT_LT((wrench_of(body, u) - expected).norm(), 1e-13);
      const VectorXd rates = body.velocity(v, omega);
      const model::IntervalWork work =
          body.model->work({.q0 = body.q, .q1 = body.q, .q = body.q, .v = rates, .u = u, .dt = 0.1});
      EXPECT_NEAR(work.external, 0.1 * (expected.head<3>().dot(v) + expected.tail<3>().dot(omega)), 1e-14);
      EXPECT_EQ(work.dissipated, 0.0);
    }
  }
}

TEST(Loads, WithoutControlAreConstant) {
  std::mt19937 random(44);
  const Body body(random, {{.name = "l", .direction = Vector3d::UnitX(), .constant = 5.0, .control_factor = 3.0}});
  EXPECT_NEAR(wrench_of(body, {})[0], 5.0, 1e-14);
}

}  // namespace
}  // namespace muldi::multibody
