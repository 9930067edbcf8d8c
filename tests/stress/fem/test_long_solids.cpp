/// Solids over 1e5 steps: momenta, volumes, energy, the way back (numerics 5 nos. 1b, 5, 13, 15).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/figure.hpp"
#include "support/solid_system.hpp"
#include "support/trajectory.hpp"

namespace muldi::fem {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr long steps = 100'000;

constexpr double dt = 5e-3;

/// A free cube of distorted cells under a voltage, without viscosity.
test::SolidSystem charged_cube(Formulation formulation) {
  test::SolidSystem system = test::solid_of(test::cube_of(2));
  system.set_potential(test::plane(2, 0.0), {});
  system.set_potential([](const Vector3d& X) { return X[2] > 1 - 1e-9 && X[0] < 0.8; }, {.constant = 1e4});
  Material material = test::rubber(0.233, 10.0, formulation);
  material.electric = IdealDielectric{.permittivity = 3.7 * test::eps0_si};
  system.fill(material, 0.233, formulation);
  return system;
}

/// Spinning and drifting.
variational::State thrown(const test::SolidSystem& system, const model::Model& model) {
  VectorXd v = test::spin(system, {0.5, -1.0, 0.7});
  for (int n = 0; n < system.n_nodes(); ++n) v.segment<3>(3 * n) += Vector3d(0.02, 0.01, -0.03);
  return test::moving_state(model, dt, v);
}

void expect_steady(Formulation formulation, const std::string& name) {
  const test::SolidSystem system = charged_cube(formulation);
  const auto model = test::make_model(system);
  const Solid& solid = test::solid_in(*model);
  Vector3d linear, angular;
  double of_momenta = 0.0;
  double of_volume = 0.0;
  double H0 = 0.0;
  test::Band band;
  // What the stopping tolerance leaves in every step adds up: to ten times itself in the angular momentum.
  const test::Run done =
      test::run(*model, thrown(system, *model), {.dt = dt, .steps = steps, .step = {.tolerance = 1e-12}},
                [&](const variational::NodeRecord& node) {
                  const double H = node.values.total.kinetic + node.values.total.potential();
                  if (node.step == 0) {
                    linear = node.values.linear_momentum;
                    angular = node.values.angular_momentum;
                    H0 = H;
                  }
                  band.add(H - H0, node.step, steps);
                  of_momenta = std::max({of_momenta, (node.values.linear_momentum - linear).norm() / linear.norm(),
                                         (node.values.angular_momentum - angular).norm() / angular.norm()});
                  const auto J = solid.volumes_at(node.state.q).J.array();
                  of_volume = std::max(of_volume, (J - 1.0).abs().maxCoeff());
                });
  ASSERT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
  test::record_figure("5", "free solid, 1e5 steps, " + name + ": momenta, relative", of_momenta, 1e-10);
  // Nonlinear waves share their energy out over ever finer ones: no faster than the square root of time, which
  // makes 3.2 of ten times the time; a drift would make 10.
  test::record_figure("1b", "free solid, 1e5 steps, " + name + ": energy band of the last tenth over that of the first",
                      band.last_tenth / band.first_tenth, 3.2);
  test::record_figure("1b", "free solid, 1e5 steps, " + name + ": max |H - H0| / H0 over dt^2 (1/ms^2)",
                      band.all / std::abs(H0) / (dt * dt), 100.0);
  if (solid.is_incompressible()) {
    test::record_figure("13", "free solid, 1e5 steps, max |J - 1| of a cell", of_volume, 1e-12);
  }
}

TEST(LongSolids, OfDisplacementsKeepTheirMomenta) { expect_steady(Formulation::displacement, "displacements"); }

TEST(LongSolids, ExactlyIncompressibleKeepTheirMomentaAndVolumes) {
  expect_steady(Formulation::incompressible, "exact incompressibility");
}

TEST(LongSolids, ReturnFromTenThousandSteps) {
  for (const Formulation formulation :
       {Formulation::displacement, Formulation::mean_dilatation, Formulation::incompressible}) {
    const test::SolidSystem system = charged_cube(formulation);
    const auto model = test::make_model(system);
    test::record_figure("15", "free solid, 1e4 steps there and back, positions (mm of 1 mm)",
                        test::distance_after_return(*model, thrown(system, *model),
                                                    {.dt = dt, .steps = 10'000, .step = {.tolerance = 1e-12}}),
                        1e-9);
  }
}

}  // namespace
}  // namespace muldi::fem
