/// Conserved quantities of bodies and the solids tied to them, and how far a factor lasts (numerics 5 nos. 5, 6, 29).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <iostream>

#include "math/rotation.hpp"
#include "multibody/registry.hpp"
#include "support/figure.hpp"
#include "support/tied_system.hpp"
#include "support/trajectory.hpp"
#include "variational/stepper.hpp"

namespace muldi::fem {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double eps = 3.0 * 8.8542e-12;

/// Two free bodies with a muscle between them under a constant field.
test::TiedSystem dumbbell(Formulation formulation) {
  test::TiedSystem system;
  system.rigid.length = 20.0;
  system.rigid.add_body(1.0, Vector3d(20.0, 15.0, 10.0), {.position = Vector3d(0.5, 0.0, -2.0)});
  system.rigid.add_body(0.7, Vector3d(10.0, 15.0, 12.0), {.position = Vector3d(0.0, 0.4, 10.0)});
  SolidDescription bar = test::muscle(
      "bar", {.cells = {2, 2, 4}, .formulation = formulation, .viscosity = 0.05, .field = 0, .permittivity = eps}, 0.0,
      {0.0, 8.0});
  system.tie(bar, test::plane(2, 0.0), 0);
  system.tie(bar, test::plane(2, 8.0), 1);
  system.solids.push_back(bar);
  system.rigid.controls = {{.name = "field", .unit = {}, .function = 2e4}};
  return system;
}

/// Velocities of a rigid motion of all bodies, and of the nodes with them.
variational::State thrown(const model::Model& model, double dt, const Vector3d& velocity, const Vector3d& omega) {
  variational::State state = test::tied_state(model, dt, VectorXd::Zero(model.manifold->n_v()));
  VectorXd wanted = VectorXd::Zero(model.n_q());
  for (Eigen::Index i = 0; i < model.n_q(); i += 3) {
    const bool is_director = i < model.manifold->n_q() && i % 12 != 0;
    wanted.segment<3>(i) = omega.cross(Vector3d(state.q.segment<3>(i)));
    if (!is_director) wanted.segment<3>(i) += velocity;
  }
  const Eigen::MatrixXd T = test::dense_null_space(test::manifold_of(model), state.x);
  const VectorXd w = T.colPivHouseholderQr().solve(VectorXd(wanted.head(T.rows())));
  return test::tied_state(model, dt, w, wanted);
}

TEST(TiedMotion, KeepsTheMomentumOfAFloatingMuscleAndItsBodies) {
  for (const Formulation formulation : {Formulation::mean_dilatation, Formulation::incompressible}) {
    const auto model = test::make_model(dumbbell(formulation));
    const double dt = 0.2;
    Vector3d linear, angular;
    double largest = 0.0;
    double drift = 0.0;
    const test::Run done =
        test::run(*model, thrown(*model, dt, {0.02, 0.01, -0.03}, {0.01, -0.02, 0.015}),
                  {.dt = dt, .steps = 1200, .step = {.tolerance = 1e-11}}, [&](const variational::NodeRecord& node) {
                    if (node.step == 0) linear = node.values.linear_momentum, angular = node.values.angular_momentum;
                    largest = std::max({largest, (node.values.linear_momentum - linear).norm() / linear.norm(),
                                        (node.values.angular_momentum - angular).norm() / angular.norm()});
                    drift = std::max(drift, model->manifold->violation(node.state.q));
                  });
    ASSERT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
    test::record_figure("5", "muscle between two free bodies, momenta, relative", largest, 1e-10);
    EXPECT_LT(drift, 1e-11);
    std::cout << "momentum " << largest << ", drift " << drift << ", factorisations "
              << done.result.statistics.factorisations << '\n';
  }
}

TEST(TiedMotion, TheForceOfTheTiesIsTheRateOfMomentumOfTheBody) {
  const auto model = test::make_model(dumbbell(Formulation::incompressible));
  const Solid& solid = test::solid_of(*model, 0);
  const double dt = 0.2;
  const double mass = 0.7;
  std::vector<Vector3d> positions;
  std::vector<Vector3d> forces;
  test::run(*model, thrown(*model, dt, {0.02, 0.01, -0.03}, {0.01, -0.02, 0.015}),
            {.dt = dt, .steps = 20, .step = {.tolerance = 1e-12}}, [&](const variational::NodeRecord& node) {
              positions.push_back(node.state.q.segment<3>(12));
              Vector3d sum = Vector3d::Zero();
              for (const Tie& tie : solid.data().ties) {
                if (tie.host == 1) sum += node.constraint_force.segment<3>(solid.q_slice().first + 3 * tie.node);
              }
              forces.push_back(sum);
            });
  double missed = 0.0;
  for (std::size_t n = 1; n + 1 < positions.size(); ++n) {
    const Vector3d rate = mass * (positions[n + 1] - 2.0 * positions[n] + positions[n - 1]) / (dt * dt);
    missed = std::max(missed, (rate + forces[n]).norm() / std::max(1.0, forces[n].norm()));
  }
  test::record_figure("29", "force of the ties against the rate of momentum of the body (N)", missed, 1e-8);
  EXPECT_GT(forces[1].norm(), 1e-2);
}

/// A heavy pendulum carries a light flap on a hinge, which a muscle holds: the muscle swings far and is strained
/// little.
test::TiedSystem swinging_muscle() {
  test::TiedSystem system = test::hinge_with_muscle({.cells = {2, 2, 4}, .viscosity = 0.1});
  test::RigidSystem& rigid = system.rigid;
  test::RigidSystem swing;
  swing.length = 40.0;
  swing.gravity = Vector3d(0.0, 0.0, -9.81e-3);
  swing.add_body(50.0, Vector3d(2e3, 2e3, 1e3), {.position = Vector3d(0.0, 0.0, -10.0)});
  swing.add_body(2.0, Vector3d(60.0, 50.0, 40.0), {.position = rigid.poses[0].position});
  const Eigen::Matrix3d about_y = math::triad_about(Vector3d::UnitY());
  swing.connect(multibody::Revolute::pattern, {multibody::ground, 0}, Vector3d(0.0, 0.0, 30.0), about_y);
  swing.connect(multibody::Revolute::pattern, {0, 1}, Vector3d(0.0, 0.0, 4.0), about_y);
  rigid = swing;
  SolidDescription bar = test::muscle("bar", {.cells = {2, 2, 4}, .viscosity = 0.1}, 6.0, {0.0, 8.0});
  system.tie(bar, test::plane(2, 0.0), 0);
  system.tie(bar, test::plane(2, 8.0), 1);
  system.solids = {bar};
  return system;
}

TEST(TiedMotion, FewFactorsServeALargeSwing) {
  const auto model = test::make_model(swinging_muscle());
  const double dt = 0.5;
  // The first joint's rate; the flap and the muscle turn with it.
  VectorXd w = VectorXd::Zero(2);
  w[0] = 0.02;
  variational::State start = test::tied_state(*model, dt, w);
  VectorXd v = VectorXd::Zero(model->n_q());
  const Solid& solid = test::solid_of(*model, 0);
  const Eigen::MatrixXd T = test::dense_null_space(test::manifold_of(*model), start.x);
  const Vector3d turn = T.col(0).segment<3>(3 + 3).norm() > 0.0 ? Vector3d(0.0, 1.0, 0.0) : Vector3d::Zero();
  const double sense = T.col(0).segment<3>(9)[0] > 0.0 ? 1.0 : -1.0;  // d3 moves along x for a turn about +y
  for (Eigen::Index i = solid.q_slice().first; i < solid.q_slice().end(); i += 3) {
    v.segment<3>(i) = sense * w[0] * turn.cross(Vector3d(start.q.segment<3>(i)) - Vector3d(0.0, 0.0, 30.0));
  }
  start = test::tied_state(*model, dt, w, v);
  double least = 0.0;
  double most = 0.0;
  const test::Run done = test::run(*model, start, {.dt = dt, .steps = 600}, [&](const variational::NodeRecord& node) {
    least = std::min(least, node.state.x[0]);
    most = std::max(most, node.state.x[0]);
  });
  ASSERT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
  std::cout << "from " << least << " to " << most << " rad: " << done.result.statistics.factorisations
            << " factorisations, " << static_cast<double>(done.result.statistics.iterations) / 600 << " iterations\n";
  EXPECT_GT(most - least, 1.0);
  // A factor costs some six iterations (FactorUse): all of them less than a twentieth of the run.
  EXPECT_LE(6 * 20 * done.result.statistics.factorisations, done.result.statistics.iterations);
}

}  // namespace
}  // namespace muldi::fem
