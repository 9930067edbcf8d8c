/// The stiffness of joints that finite-element muscles hold, against differences of equilibria under joint forces.
#include <gtest/gtest.h>

#include <cmath>

#include "math/derivative_check.hpp"
#include "multibody/registry.hpp"
#include "statics/equilibrium.hpp"
#include "statics/sweep.hpp"
#include "support/tied_system.hpp"

namespace muldi::statics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double eps = 3.0 * 8.8542e-12;

/// A universal joint with a muscle at a corner, driven on both axes: controls 0 and 1 are the torques, 2 the field. A
/// world force bends the body too, which turns with the joint.
test::TiedSystem bent(fem::Formulation formulation) {
  test::TiedSystem system;
  system.rigid.length = 20.0;
  system.rigid.add_body(2.0, Vector3d(60.0, 50.0, 40.0), {.position = Vector3d(0.0, 0.0, 14.0)});
  system.rigid.connect(multibody::Universal::pattern, {multibody::ground, 0}, Vector3d(0.0, 0.0, 4.0));
  for (int k = 0; k < 2; ++k) {
    system.rigid.joint_forces.push_back({.joint = 0, .motion = static_cast<std::size_t>(k), .control = k});
  }
  system.rigid.loads.push_back({.name = "load",
                                .body = 0,
                                .point = Vector3d(1.0, 2.0, 5.0),
                                .direction = Vector3d(0.3, -0.5, -1.0),
                                .constant = 0.1});
  fem::SolidDescription bar = test::muscle(
      "bar", {.cells = {2, 2, 4}, .formulation = formulation, .field = 2, .permittivity = eps}, 4.0, {0.0, 8.0});
  system.tie(bar, test::plane(2, 0.0), multibody::ground);
  system.tie(bar, test::plane(2, 8.0), 0);
  system.solids.push_back(bar);
  for (const char* name : {"first", "second", "field"}) {
    system.rigid.controls.push_back({.name = name, .unit = {}, .function = 0.0});
  }
  return system;
}

TEST(TiedTangent, IsTheChangeOfJointForcesOverThatOfTheJoint) {
  for (const fem::Formulation formulation :
       {fem::Formulation::displacement, fem::Formulation::mean_dilatation, fem::Formulation::incompressible}) {
    const auto model = test::make_model(bent(formulation));
    EquilibriumSolver solver(*model, {.tolerance = 1e-12});
    StaticState at = test::static_start(*model);
    model->manifold->configuration(at.x, at.q);
    for (const auto& part : model->substructures) part->start(at.q, at.y);
    const std::vector<double> u = {0.8, -0.5, 2e4};
    const EquilibriumReport report = solver.solve(at, u);
    ASSERT_TRUE(report.converged);
    EXPECT_EQ(report.stability, Stability::stable);
    EXPECT_LT(report.residual, 1e-10);
    EXPECT_GT(at.x.norm(), 0.02);
    solver.linearise(at, u);
    const MatrixXd A = solver.tangent();
    const auto rates = [&](const VectorXd& torque) -> VectorXd {
      StaticState moved = at;
      EXPECT_TRUE(solver.solve(moved, {{u[0] + torque[0], u[1] + torque[1], u[2]}}).converged);
      VectorXd w(2);
      model->manifold->difference(at.x, moved.x, w);
      return w;
    };
    const MatrixXd compliance = math::difference_jacobian(rates, VectorXd::Zero(2), VectorXd::Constant(2, 0.05));
    EXPECT_LT(math::derivative_error(A.inverse(), compliance).relative, 1e-7);
  }
}

TEST(TiedTangent, AMuscleTooWeakForTheLoadOfABodyIsUnstable) {
  // Gravity on the body above the hinge: the equilibrium of the upright body is unstable where m g h is greater than
  // the stiffness of the muscle about the hinge.
  for (const bool heavy : {false, true}) {
    test::TiedSystem system = test::hinge_with_muscle({.cells = {2, 2, 4}});
    system.rigid.gravity = Vector3d(0.0, 0.0, -9.81e-3);
    system.rigid.bodies[0].mass = heavy ? 4e4 : 4.0;
    const auto model = test::make_model(system);
    EquilibriumSolver solver(*model, {});
    StaticState at = test::static_start(*model);
    model->manifold->configuration(at.x, at.q);
    for (const auto& part : model->substructures) part->start(at.q, at.y);
    solver.linearise(at, {});
    EXPECT_EQ(solver.stability(), heavy ? Stability::unstable : Stability::stable);
    const double fall = system.rigid.bodies[0].mass * 9.81e-3 * 10.0;
    EXPECT_GT(solver.tangent()(0, 0) + fall, 0.0);
  }
}

}  // namespace
}  // namespace muldi::statics
