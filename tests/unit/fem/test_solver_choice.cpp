/// Linear solvers of solids: results do not depend on them, nor on the number of threads.
#include <gtest/gtest.h>

#include <array>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "fem/solid/solid_factor.hpp"
#include "fem/solid/solver_choice.hpp"
#include "statics/equilibrium.hpp"
#include "support/figure.hpp"
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
      for (const char* solver : {"auto", "ldlt", "cholmod", "umfpack", "iterative", "minres", "gmres"}) {
        EXPECT_LT((after_steps(system, solver, 4) - direct).lpNorm<Eigen::Infinity>(), 1e-9)
            << solver << ' ' << static_cast<int>(formulation) << ' ' << legacy;
      }
    }
  }
}

TEST(SolverChoice, IteratesStifferStepsOfLargerSolids) {
  // Eight times the unknowns: 16 times the solve with a factor of a cube, 8 times the iteration, whose number grows
  // with the root of the stiffness; it may double, so that the stiffness may be four times as large.
  EXPECT_NEAR(stiffest_step(8 * 20'000) / stiffest_step(20'000), 4.0, 1e-12);
}

struct AtRest {
  VectorXd q;
  statics::Stability stability;
};

AtRest at_rest(const test::SolidSystem& system, const std::string& solver) {
  const auto model = test::make_model(system);
  statics::StaticState state = test::static_start(*model);
  const auto report = statics::EquilibriumSolver(*model, {.substructures = solver}).solve(state, {});
  EXPECT_TRUE(report.converged) << solver;
  return {state.q, report.stability};
}

TEST(SolverChoice, DoesNotChangeEquilibria) {
  for (const Formulation formulation : {Formulation::mean_dilatation, Formulation::incompressible}) {
    for (const bool legacy : {true, false}) {
      const test::SolidSystem system = cube(4, formulation, legacy, true);
      const AtRest direct = at_rest(system, "direct");
      for (const char* solver : {"cholmod", "umfpack", "iterative"}) {
        const AtRest other = at_rest(system, solver);
        EXPECT_LT((other.q - direct.q).lpNorm<Eigen::Infinity>(), 1e-10)
            << solver << ' ' << static_cast<int>(formulation) << ' ' << legacy;
        EXPECT_EQ(other.stability, direct.stability) << solver;
      }
    }
  }
}

/// One hexahedron of four unknowns a node whose matrix has zeros on the diagonal: no factor without pivoting.
TEST(SolverChoice, AMatrixThatNeedsPivotsIsFactorisedByUmfpack) {
  const std::vector<std::array<int, 8>> cells = {{0, 1, 2, 3, 4, 5, 6, 7}};
  const math::SymmetricBlockPattern pattern(8, 4, cells);
  math::NodeMask mask(8, 0);
  mask[0] = 0b0011;
  SolidFactor factor(pattern, mask, {}, math::FactorStorage::double_precision, 16);
  math::SymmetricBlockMatrix& A = factor.matrix();
  // Pairs of nodes (a, a + 1) coupled by the identity: eigenvalues +1 and -1, sixteen of each.
  const auto couple = [&](int a, int b) {
    double* block = A.values().data() + 16 * pattern.slot(a, b);
    for (int i = 0; i < 4; ++i) block[5 * i] = 1.0;
  };
  for (int a = 0; a < 8; a += 2) couple(a, a + 1);
  // The partners of the masked unknowns are masked with them.
  mask[1] = 0b0011;
  SolidFactor whole(pattern, mask, {}, math::FactorStorage::double_precision, 14);
  std::copy(A.values().begin(), A.values().end(), whole.matrix().values().begin());
  ASSERT_TRUE(whole.factorise());
  EXPECT_TRUE(whole.is_pivoted());
  EXPECT_EQ(whole.n_negative(), 14);
  VectorXd x = VectorXd::LinSpaced(32, 1.0, 32.0);
  whole.solve(x);
  for (int i = 0; i < 32; ++i) {
    const bool masked = i % 8 < 2 && i < 8 ? true : i == 4 || i == 5;
    const int partner = i / 4 % 2 == 0 ? i + 4 : i - 4;
    EXPECT_NEAR(x[i], masked ? 0.0 : 1.0 + partner, 1e-12) << i;
  }
  // Without their partners the unknowns 4 and 5 have no equation.
  EXPECT_FALSE(factor.factorise());
}

TEST(SolverChoice, StiffStepsOfLargeSolidsAreFactorised) {
  // 17^3 nodes, 18 thousand unknowns: the diagonal over that of the mass is 1 + (3/4 c_P^2 dt^2 + 3/2 eta dt/rho)/h^2
  // and a little more by shear, c_P^2 = (20 + 2 mu)/rho, rho 1e-3, eta .4, h 1/8.
  const auto model = test::make_model(cube(16, Formulation::displacement, true, false));
  for (const double dt : {1e-4, 1e-2}) {
    variational::State state = test::moving_state(*model, dt);
    const auto& part = *model->substructures.front();
    part.place({.u = {}, .u_end = {}}, state.q, state.y);
    const VectorXd v = VectorXd::Zero(state.q.size());
    const auto solver = part.make_solver(model::Linearisation::step, "auto");
    EXPECT_EQ(solver->name(), "solid cg (chebyshev, multigrid)");
    ASSERT_TRUE(
        solver->factorise({.q0 = state.q, .q1 = state.q, .q = state.q, .v = v, .u = {}, .dt = dt, .y = &state.y}));
    EXPECT_EQ(solver->name(), dt < 1e-3 ? "solid cg (chebyshev, multigrid)" : "solid ldlt (nested_dissection)");
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
    test::record_figure("16", "solid by iterations on 1 and on 3 threads, largest difference (mm)",
                        (q[0] - q[1]).lpNorm<Eigen::Infinity>(), 0.0);
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
  EXPECT_EQ(solid.solver_size(Linearisation::step, "cholmod").solver, "solid cholmod");
  EXPECT_EQ(solid.solver_size(Linearisation::rest, "umfpack").solver, "solid umfpack");
  EXPECT_GT(solid.solver_size(Linearisation::rest, "umfpack").factor_bytes, 8.0 * 16 * 125 * 14);
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
