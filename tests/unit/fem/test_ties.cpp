/// Nodes that follow rigid bodies, against the same equations with multipliers (numerics 1.9, 5 no. 29).
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "base/parallel.hpp"
#include "math/rotation.hpp"
#include "multibody/registry.hpp"
#include "support/tied_system.hpp"
#include "support/trajectory.hpp"

namespace muldi::fem {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double eps = 3.0 * 8.8542e-12;

/// Largest distance of a tied node from the point of its body.
double tie_error(const Solid& solid, const VectorXd& q) {
  VectorXd followed = q;
  solid.ties().follow(solid.q_slice().first, followed);
  return (followed - q).lpNorm<Eigen::Infinity>();
}

TEST(Ties, MoveAHingeWithOneMuscle) {
  for (const Formulation formulation :
       {Formulation::displacement, Formulation::mean_dilatation, Formulation::incompressible}) {
    test::TiedSystem system = test::hinge_with_muscle({.formulation = formulation, .field = 0, .permittivity = eps});
    system.rigid.controls = {{.name = "field", .unit = {}, .function = 2e4}};
    const auto model = test::make_model(system);
    const variational::State start = test::tied_state(*model, 0.5, VectorXd::Constant(1, 0.01));
    double error = 0.0;
    double energy = 0.0;
    double first = 0.0;
    long factorisations = 0;
    const test::Run done = test::run(*model, start, {.dt = 0.5, .steps = 40}, [&](const auto& node) {
      error = std::max(error, tie_error(test::solid_of(*model, 0), node.state.q));
      energy = node.values.total.kinetic + node.values.total.potential();
      if (node.step == 0) first = energy;
      std::cout << node.step << " x " << node.state.x.transpose() << " E " << energy << " it " << node.report.iterations
                << " f " << node.report.factorisations << " res " << node.report.residual << "\n";
    });
    factorisations = done.result.statistics.factorisations;
    EXPECT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
    EXPECT_EQ(error, 0.0);
    std::cout << "factorisations " << factorisations << " iterations " << done.result.statistics.iterations << '\n';
  }
}

}  // namespace
}  // namespace muldi::fem
