/// Order of the coupled step, and its power balance (numerics 5 nos. 3, 24).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <iostream>

#include "support/tied_system.hpp"
#include "support/trajectory.hpp"

namespace muldi::fem {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// A hinge with a soft muscle whose nodes turn with the body by their height, so that no wave starts.
struct SmoothHinge {
  std::unique_ptr<model::Model> model;
  variational::State state;
};

SmoothHinge smooth_hinge(Formulation formulation, double dt) {
  const test::TiedSystem system =
      test::hinge_with_muscle({.cells = {1, 1, 3}, .formulation = formulation, .viscosity = 0.2});
  SmoothHinge hinge{.model = test::make_model(system), .state = {}};
  const VectorXd w = VectorXd::Constant(1, 0.02);
  hinge.state = test::tied_state(*hinge.model, dt, w);
  const Solid& solid = test::solid_of(*hinge.model, 0);
  const Eigen::MatrixXd T = test::dense_null_space(test::manifold_of(*hinge.model), hinge.state.x);
  const double sense = T.col(0).segment<3>(9)[0] > 0.0 ? 1.0 : -1.0;
  VectorXd v = VectorXd::Zero(hinge.model->n_q());
  for (Eigen::Index i = solid.q_slice().first; i < solid.q_slice().end(); i += 3) {
    const Vector3d at = hinge.state.q.segment<3>(i);
    const double share = 0.5 * (1.0 - std::cos(3.14159265358979 * at[2] / 8.0));
    v.segment<3>(i) = share * sense * w[0] * Vector3d::UnitY().cross(at - Vector3d(0.0, 0.0, 4.0));
  }
  hinge.state = test::tied_state(*hinge.model, dt, w, v);
  return hinge;
}

TEST(TiedOrder, IsTwoInPositionsMomentaAndReactions) {
  for (const Formulation formulation : {Formulation::displacement, Formulation::mean_dilatation}) {
    const double dt = 0.02;
    const SmoothHinge hinge = smooth_hinge(formulation, dt);
    const test::Orders orders =
        test::observed_orders(*hinge.model, hinge.state, {.dt = dt, .steps = 100, .step = {.tolerance = 1e-12}});
    std::cout << "orders " << orders.q << ' ' << orders.momentum << ' ' << orders.reaction << '\n';
    EXPECT_NEAR(orders.q, 2.0, 0.05);
    EXPECT_NEAR(orders.momentum, 2.0, 0.05);
    EXPECT_NEAR(orders.reaction, 2.0, 0.05);
  }
}

/// |energy - energy at the start + what was dissipated| after 2 ms.
double imbalance(Formulation formulation, double dt) {
  const SmoothHinge hinge = smooth_hinge(formulation, dt);
  double first = 0.0;
  double last = 0.0;
  const test::Run done =
      test::run(*hinge.model, hinge.state, {.dt = dt, .steps = std::lround(2.0 / dt), .step = {.tolerance = 1e-12}},
                [&](const variational::NodeRecord& node) {
                  last = node.values.total.kinetic + node.values.total.potential();
                  if (node.step == 0) first = last;
                  last += node.ledger.dissipated;
                });
  EXPECT_GT(done.ledger.dissipated, 1e-4 * first);
  return std::abs(last - first);
}

TEST(TiedOrder, ThePowerBalanceClosesAsTheSquareOfTheStep) {
  const double coarse = imbalance(Formulation::displacement, 0.02);
  const double fine = imbalance(Formulation::displacement, 0.01);
  std::cout << "imbalance " << coarse << ' ' << fine << '\n';
  EXPECT_NEAR(coarse / fine, 4.0, 0.3);
}

}  // namespace
}  // namespace muldi::fem
