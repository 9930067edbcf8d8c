/// Linear solvers of solids: results do not depend on them, nor on the number of threads.
#include <gtest/gtest.h>

#include <array>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "support/solid_system.hpp"
#include "variational/stepper.hpp"

namespace muldi::fem {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double mu = 0.233;

/// A viscous cube with an electrode on a part of its top; some formulations with a floating electrode in the middle.
test::SolidSystem cube(int n, Formulation formulation, bool legacy, bool floating) {
  test::SolidSystem system = test::solid_box({n, n, n}, {-1, -1, -1}, {1, 1, 1});
  system.hold_lower_faces();
  system.set_potential(test::plane(1, -1.0), {});
  system.set_potential([](const Vector3d& X) { return X[1] > 1 - 1e-9 && X[0] < -1e-9; }, {.constant = 20e3});
  if (floating) system.solid.floating.push_back({.name = "layer", .nodes = system.nodes(test::plane(1, 0.0))});
  Material material = test::rubber(mu, 20.0, formulation);
  material.electric = IdealDielectric{.permittivity = 3.7 * test::eps0_si};
  if (legacy) material.electric = Vu{.c1 = 5e-8, .c2 = 1e-9, .eps0 = test::eps0_si};
  material.viscous = KelvinVoigt{.viscosity = 0.4};
  system.fill(material, mu, formulation);
  return system;
}

VectorXd after_steps(const test::SolidSystem& system, const std::string& solver, int steps) {
  const auto model = test::make_model(system);
  const double dt = 1e-3;
  variational::State state = test::moving_state(*model, dt);
  variational::Stepper stepper(*model, dt, {.substructures = solver});
  while (state.step < steps) {
    const variational::StepReport report = stepper.advance(state, {});
    EXPECT_EQ(report.status, variational::Status::running) << solver << ": " << report.sentence;
    if (report.status != variational::Status::running) break;
  }
  return state.q;
}

TEST(SolverChoice, DoesNotChangeResults) {
  for (const Formulation formulation : test::formulations) {
    for (const bool legacy : {true, false}) {
      const test::SolidSystem system = cube(4, formulation, legacy, true);
      const VectorXd direct = after_steps(system, "direct", 4);
      const double moved = (direct - system.solid.X).lpNorm<Eigen::Infinity>();
      EXPECT_GT(moved, 1e-7);
      for (const char* solver : {"auto", "ldlt", "iterative", "minres", "gmres"}) {
        EXPECT_LT((after_steps(system, solver, 4) - direct).lpNorm<Eigen::Infinity>(), 1e-9)
            << solver << ' ' << static_cast<int>(formulation) << ' ' << legacy;
      }
    }
  }
}

TEST(SolverChoice, IterationsGiveTheSameBitsForAnyNumberOfThreads) {
  for (const bool legacy : {true, false}) {
    const test::SolidSystem system = cube(12, Formulation::displacement, legacy, false);
    std::array<VectorXd, 2> q;
    for (const int threads : {1, 3}) {
      base::set_threads(threads);
      q[threads == 1 ? 0 : 1] = after_steps(system, "iterative", 2);
    }
    base::set_threads(1);
    EXPECT_TRUE(q[0] == q[1]) << legacy;
  }
}

TEST(SolverChoice, IsNamedAndSized) {
  const auto model = test::make_model(cube(4, Formulation::displacement, false, false));
  const Solid& solid = test::solid_in(*model);
  using model::Linearisation;
  EXPECT_EQ(solid.solver_size(Linearisation::step, "auto").solver, "solid ldlt (nested_dissection)");
  const model::SolverSize iterative = solid.solver_size(Linearisation::step, "iterative");
  EXPECT_EQ(iterative.solver, "solid gmres (chebyshev, multigrid)");
  // 13 neighbours and itself for each of 5^3 nodes, less at the surface.
  EXPECT_GT(iterative.matrix_bytes, 8.0 * 16 * 125 * 7);
  EXPECT_LT(iterative.matrix_bytes, 8.0 * 16 * 125 * 14);
  EXPECT_EQ(solid.solver_size(Linearisation::velocity, "cg").solver, "solid cg (chebyshev, multigrid)");
  EXPECT_THROW(solid.check_solver("cg"), base::InputError);
  EXPECT_NO_THROW(solid.check_solver("minres"));
}

TEST(SolverChoice, PotentialsOfLargeMeshesAreInEquilibrium) {
  // Beyond 30000 potentials by multigrid.
  const auto model = test::make_model(cube(32, Formulation::displacement, false, false));
  const Solid& solid = test::solid_in(*model);
  ASSERT_GT(solid.unknowns().n_free_potentials(), 30000);
  const VectorXd x = solid.elements().reference();
  const VectorXd phi = solid.potentials_at(x, {});
  VectorXd rows = solid.charge_rows(x, phi);
  const double largest = rows.lpNorm<Eigen::Infinity>();
  solid.unknowns().keep_solved_potentials(rows);
  EXPECT_LT(rows.lpNorm<Eigen::Infinity>(), 1e-12 * largest);
  EXPECT_GT(phi.maxCoeff(), 2e4 - 1e-9);
}

}  // namespace
}  // namespace muldi::fem
