/// What keeps the volume: locking, the unreduced equations of exact incompressibility, the inf-sup value (numerics 5
/// nos. 12, 13).
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "support/figure.hpp"
#include "support/solid_cubes.hpp"
#include "variational/stepper.hpp"

namespace muldi::fem {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double mu = test::cube_mu;

/// Deflection of the tip of a clamped block 10 x 2 x 2 under a dead load.
double deflection(double nu, Formulation formulation) {
  test::SolidSystem system = test::solid_box({10, 2, 2}, {0, 0, 0}, {10, 2, 2});
  for (int i = 0; i < 3; ++i) system.hold(test::plane(0, 0.0), i);
  DeadLoad end{.nodes = system.nodes(test::plane(0, 10.0)), .unit = {}, .value = {.constant = 1e-3}};
  end.unit.assign(end.nodes.size(), Vector3d(0, 0, 1.0 / static_cast<double>(end.nodes.size())));
  system.solid.dead_loads.push_back(end);
  system.fill(test::rubber(mu, 2.0 * mu * nu / (1.0 - 2.0 * nu), formulation), mu, formulation);
  const auto model = test::make_model(system);
  statics::StaticState state = test::static_start(*model);
  const statics::EquilibriumReport report = statics::EquilibriumSolver(*model, {}).solve(state, {});
  EXPECT_TRUE(report.converged) << report.inadmissible;
  return state.q[3 * system.node_at({10, 1, 1}) + 2] - 1.0;
}

TEST(SolidVolume, MeanDilatationTendsToTheIncompressibleLimitWhereDisplacementsLock) {
  const double limit = deflection(0.0, Formulation::incompressible);
  double before = 1.0;
  for (const double nu : {0.49, 0.499, 0.4999, 0.49999, 0.499999}) {
    const double gap = std::abs(deflection(nu, Formulation::mean_dilatation) / limit - 1.0);
    EXPECT_LT(gap, 0.2 * before) << nu;
    before = gap;
    const std::string of = "clamped block, nu " + test::short_number(nu) + ": ";
    if (nu > 0.4995) test::record_figure("12", of + "mean dilatation to the incompressible one", gap, 1e-2);
    const double plain = deflection(nu, Formulation::displacement) / limit;
    if (nu > 0.4995) test::record_figure("12", of + "displacements alone, of the right deflection", plain, 0.5);
  }
}

/// A free cube of distorted cells, thrown and spinning, exactly incompressible.
test::SolidSystem thrown_cube() {
  test::SolidSystem system = test::solid_of(test::cube_of(2));
  system.fill(test::rubber(mu, 0.0, Formulation::incompressible), mu, Formulation::incompressible);
  return system;
}

/// The unreduced equations of one step (thesis 5, model III): positions r_1, element dilatations J~, pressures p and
/// multipliers lambda of J~ = 1, in one dense Newton iteration with differences for its matrix:
///     p_n + dt/2 F - pi - c V p g(r_0) = 0,  J_e(r_1) - J~ = 0,  lambda - p = 0,  J~ - 1 = 0.
class UnreducedStep {
 public:
  UnreducedStep(const model::Model& model, double dt) : model_(model), solid_(test::solid_in(model)), dt_(dt) {
    forces_.force = forces_.momentum = forces_.begin = forces_.end = VectorXd::Zero(model.n_q());
    forces_.stage = VectorXd::Zero(model.n_y());
  }

  void advance(variational::State& state) {
    const Eigen::Index n = state.q.size();
    const Eigen::Index cells = state.y.size();
    VectorXd z(n + 3 * cells);
    z << state.q + state.advance, VectorXd::Ones(cells), state.y, state.y;
    for (int iteration = 0; iteration < 8; ++iteration) {
      const VectorXd r = residual(state, z);
      MatrixXd K(z.size(), z.size());
      for (Eigen::Index k = 0; k < z.size(); ++k) {
        VectorXd beside = z;
        beside[k] += 1e-6;
        K.col(k) = (residual(state, beside) - r) / 1e-6;
      }
      z -= K.partialPivLu().solve(r);
    }
    residual(state, z);
    state.p = forces_.momentum + 0.5 * dt_ * forces_.force;
    state.advance = z.head(n) - state.q;
    state.q = z.head(n);
    state.y = z.segment(n + cells, cells);
    ++state.step;
  }

 private:
  VectorXd residual(const variational::State& state, const VectorXd& z) {
    const Eigen::Index n = state.q.size();
    const Eigen::Index cells = state.y.size();
    const VectorXd q1 = z.head(n);
    const VectorXd dilatation = z.segment(n, cells);
    const VectorXd p = z.segment(n + cells, cells);
    const VectorXd q = 0.5 * (state.q + q1);
    const VectorXd v = (q1 - state.q) / dt_;
    model_.forces({.q0 = state.q, .q1 = q1, .q = q, .v = v, .u = {}, .dt = dt_, .y = &p, .first = state.step == 0},
                  forces_);
    VectorXd r(z.size());
    r << state.p + 0.5 * dt_ * forces_.force - forces_.momentum + forces_.begin, solid_.volumes_at(q1).J - dilatation,
        z.tail(cells) - p, dilatation - VectorXd::Ones(cells);
    return r;
  }

  const model::Model& model_;
  const Solid& solid_;
  double dt_;
  model::IntervalForces forces_;
};

TEST(SolidVolume, TheUnreducedEquationsGiveTheSameMotion) {
  const test::SolidSystem system = thrown_cube();
  const auto model = test::make_model(system);
  const double dt = 0.02;
  variational::State state = test::moving_state(*model, dt, test::spin(system, {2.0, -4.0, 3.0}));
  variational::State referred = state;
  variational::Stepper stepper(*model, dt, {.tolerance = 1e-13});
  UnreducedStep referee(*model, dt);
  double apart = 0.0;
  double of_pressures = 0.0;
  for (int n = 0; n < 20; ++n) {
    ASSERT_EQ(stepper.advance(state, {}).status, variational::Status::running);
    referee.advance(referred);
    apart = std::max(apart, (state.q - referred.q).lpNorm<Eigen::Infinity>());
    of_pressures = std::max(of_pressures, (state.y - referred.y).lpNorm<Eigen::Infinity>() / mu);
  }
  EXPECT_GT(state.y.lpNorm<Eigen::Infinity>(), 1e-4);
  test::record_figure("13", "five-field equations against reduced ones, positions (mm of 1 mm)", apart, 1e-12);
  test::record_figure("13", "five-field equations against reduced ones, pressures over mu", of_pressures, 1e-12);
}

struct InfSup {
  double least = 0.0;  ///< smallest value that is not zero
  int zeros = 0;
};

/// beta^2: eigenvalues of B S^-1 B^T by diag(V), S the strain norm of the free nodes, B the rows V_e g_e (the numerical
/// inf-sup test of Chapelle and Bathe, Comput. Struct. 47:537-545, 1993).
InfSup inf_sup(const test::FemPatch& patch, const test::Where& held) {
  const test::FemSystem elements(patch, {.elastic = BonetWood{.mu = 1.0, .lambda = 0.0}});
  const MatrixXd K = elements.tangent({.x = patch.X, .v = {}, .phi = {}, .pressure = {}}, {});
  test::SolidSystem system = test::solid_of(patch);
  system.fill(test::rubber(1.0, 0.0, Formulation::incompressible), 1.0, Formulation::incompressible);
  const auto model = test::make_model(system);
  const Solid& solid = test::solid_in(*model);
  const Volumes& volumes = solid.volumes_at(patch.X);
  std::vector<Eigen::Index> free;
  for (int n = 0; n < patch.n_nodes(); ++n) {
    if (held(patch.node(n))) continue;
    for (int i = 0; i < 3; ++i) free.push_back(3 * n + i);
  }
  const auto n_free = static_cast<Eigen::Index>(free.size());
  MatrixXd S(n_free, n_free);
  for (Eigen::Index a = 0; a < n_free; ++a) {
    for (Eigen::Index b = 0; b < n_free; ++b) {
      const auto at = [&](Eigen::Index k) {
        return 4 * (free[static_cast<std::size_t>(k)] / 3) + free[static_cast<std::size_t>(k)] % 3;
      };
      S(a, b) = K(at(a), at(b));
    }
  }
  const VectorXd& V = solid.cell_volumes();
  MatrixXd rows = MatrixXd::Zero(V.size(), patch.X.size());
  VectorXd row(patch.X.size());
  for (Eigen::Index e = 0; e < V.size(); ++e) {
    row.setZero();
    volumes.add_gradients(solid.elements(), VectorXd::Unit(V.size(), e) * std::sqrt(V[e]), row);
    rows.row(e) = row;
  }
  const MatrixXd B = rows(Eigen::all, free);
  const VectorXd squares = Eigen::SelfAdjointEigenSolver<MatrixXd>(B * S.llt().solve(B.transpose())).eigenvalues();
  InfSup result;
  for (const double square : squares) {
    if (square < 1e-12) {
      ++result.zeros;
    } else if (result.least == 0.0) {
      result.least = std::sqrt(square);
    }
  }
  return result;
}

bool on_wall_but_top(const Vector3d& X) {
  return X[2] < 1e-9 || std::min(X[0], X[1]) < 1e-9 || std::max(X[0], X[1]) > 1.0 - 1e-9;
}

test::FemPatch regular_cube(int n) {
  const test::SolidSystem box = test::solid_box({n, n, n}, {0, 0, 0}, {1, 1, 1});
  return {.elements = box.solid.cells, .X = box.solid.X};
}

TEST(SolidVolume, InfSupValuesAreThoseOfTheElement) {
  // Clamped all around, n^3 regular cells have 3 n - 2 checkerboards (each plane of cells has its own sign) and the
  // constant; distortion leaves the constant. With a free top n checkerboards are left, one a column of planes, and a
  // distorted mesh has none.
  for (const int n : {4, 6}) {
    const std::string cells = test::short_number(n) + "^3 cells, ";
    const InfSup closed = inf_sup(regular_cube(n), test::on_wall);
    const InfSup open = inf_sup(regular_cube(n), on_wall_but_top);
    const InfSup distorted = inf_sup(test::cube_of(n), test::on_wall);
    const InfSup open_distorted = inf_sup(test::cube_of(n), on_wall_but_top);
    EXPECT_EQ(closed.zeros, 3 * n - 1);
    EXPECT_EQ(open.zeros, n);
    EXPECT_EQ(distorted.zeros, 1);
    EXPECT_EQ(open_distorted.zeros, 0);
    test::record_at_least("13", cells + "clamped: smallest inf-sup value beside its checkerboards", closed.least, 0.01);
    test::record_at_least("13", cells + "free top: smallest inf-sup value beside its checkerboards", open.least, 0.01);
    test::record_at_least("13", cells + "distorted and clamped: smallest inf-sup value", distorted.least, 0.01);
    test::record_at_least("13", cells + "distorted with a free top: smallest inf-sup value", open_distorted.least,
                          0.01);
  }
}

/// Error of the filtered pressures of a clamped distorted box under its own weight, whose displacements are zero and
/// whose pressure is hydrostatic: over the largest.
double hydrostatic_error(int n) {
  test::SolidSystem system = test::solid_of(test::cube_of(n));
  for (int i = 0; i < 3; ++i) system.hold(test::on_wall, i);
  // So little weight that nothing moves but to first order.
  const double weight = 1e-9;
  system.fill(test::rubber(mu, 0.0, Formulation::incompressible), mu, Formulation::incompressible);
  system.solid.gravity = Vector3d(0.0, 0.0, -weight / 1e-3);
  const auto model = test::make_model(system);
  const Solid& solid = test::solid_in(*model);
  statics::StaticState rest = test::static_start(*model);
  const statics::EquilibriumReport report = statics::EquilibriumSolver(*model, {}).solve(rest, {});
  EXPECT_TRUE(report.converged) << report.inadmissible;
  const VectorXd& V = solid.cell_volumes();
  double square = 0.0;
  for (Eigen::Index e = 0; e < V.size(); ++e) {
    double z = 0.0;
    for (const int node : system.solid.cells[static_cast<std::size_t>(e)]) z += system.node(node)[2] / 8.0;
    // Tension is positive: the upper part hangs.
    const double expected = weight * (z - 0.5);
    square += V[e] * std::pow(solid.pressures(rest.y)[e] - expected, 2);
  }
  return std::sqrt(square) / (0.5 * weight);
}

TEST(SolidVolume, FilteredPressuresConverge) {
  const double coarse = hydrostatic_error(4);
  const double fine = hydrostatic_error(8);
  test::record_figure("13", "hydrostatic pressure in a clamped box of 8^3 distorted cells, error", fine, 0.2);
  test::record_at_least("13", "hydrostatic pressure in a clamped box, error of 4^3 distorted cells over that of 8^3",
                        coarse / fine, 1.5);
}

}  // namespace
}  // namespace muldi::fem
