/// The exact derivative of a solid's equations, and what Newton's method does with it.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/solid/field_peaks.hpp"
#include "fem/solid/solid_action.hpp"
#include "statics/equilibrium.hpp"
#include "support/solid_cubes.hpp"
#include "variational/stepper.hpp"

namespace muldi::fem {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double mu = test::cube_mu;

/// A distorted cube between electrodes, with a pressure on an open surface.
test::SolidSystem everything(Formulation formulation) {
  test::SolidSystem system = test::charged_cube(test::plane(2, 1.0), 2e4);
  system.hold_lower_faces();
  system.solid.pressures.push_back({.faces = test::faces_in(system, 0, 1.0), .value = {.constant = 0.1}});
  system.fill(test::viscous_dielectric(formulation, 10.0, 0.5), mu, formulation);
  return system;
}

VectorXd rough(Eigen::Index n, double scale, int seed) {
  VectorXd x(n);
  for (Eigen::Index i = 0; i < n; ++i) x[i] = scale * std::sin(12.9898 * static_cast<double>(i + 1) + seed);
  return x;
}

/// The equations at one configuration, moved along a direction.
class Equations {
 public:
  Equations(const model::Model& model, double dt) : model_(model), solid_(test::solid_in(model)), dt_(dt) {
    statics::StaticState rest = test::static_start(model);
    q0_ = rest.q + rough(rest.q.size(), 0.02, 1);
    q1_ = q0_ + rough(rest.q.size(), 0.05, 2);
    y_ = rest.y;
    if (solid_.n_potentials() > 0) solid_.potentials(y_) = rough(solid_.n_potentials(), 1e4, 3);
    if (solid_.has_pressures()) solid_.pressures(y_) = rough(solid_.n_pressures(), 0.1, 4);
    dq_ = rough(q1_.size(), 1.0, 5);
    dy_ = VectorXd::Zero(y_.size());
    if (solid_.n_potentials() > 0) solid_.potentials(dy_) = rough(solid_.n_potentials(), 1e4, 6);
    if (solid_.has_pressures()) solid_.pressures(dy_) = rough(solid_.n_pressures(), 1.0, 7);
    forces_.force = forces_.momentum = forces_.begin = forces_.end = VectorXd::Zero(q1_.size());
    forces_.stage = VectorXd::Zero(y_.size());
    // Quadratic errors of U' - p: the derivative leaves them out where they are zero.
    if (solid_.data().formulation == Formulation::mean_dilatation) settle_pressures();
  }

  model::IntervalPoint point() const {
    if (dt_ > 0.0) return {.q0 = q0_, .q1 = q1_, .q = q_, .v = v_, .u = {}, .dt = dt_, .y = &y_};
    return {.q0 = q1_, .q1 = q1_, .q = q1_, .v = v_, .u = {}, .y = &y_};
  }

  void evaluate() {
    q_ = 0.5 * (q0_ + q1_);
    v_ = dt_ > 0.0 ? VectorXd((q1_ - q0_) / dt_) : VectorXd::Zero(q1_.size());
    model_.forces(point(), forces_);
  }

  /// Momentum balance and stage rows at a distance along the direction.
  VectorXd rows(double distance) {
    const VectorXd q1 = q1_;
    const VectorXd y = y_;
    q1_ += distance * dq_;
    y_ += distance * dy_;
    evaluate();
    VectorXd all(q1.size() + y.size());
    all << (dt_ > 0.0 ? VectorXd(0.5 * dt_ * forces_.force - forces_.momentum + forces_.begin) : forces_.force),
        forces_.stage;
    q1_ = q1;
    y_ = y;
    return all;
  }

  /// Minus the derivative of the rows along the direction, as SolidAction gives it.
  VectorXd action() {
    evaluate();
    SolidAction action(solid_);
    action.linearise(point());
    SolidVector along(solid_), out(solid_);
    along.x = dq_;
    if (solid_.n_potentials() > 0) along.phi = solid_.potentials(dy_);
    if (solid_.has_pressures()) along.p = solid_.pressures(dy_);
    action.apply(along, out);
    VectorXd all(q1_.size() + y_.size());
    all << out.x, out.phi, out.p;
    // Rows of prescribed potentials are not among the equations.
    solid_.unknowns().keep_solved_potentials(all.segment(q1_.size(), solid_.n_potentials()));
    return all;
  }

 private:
  void settle_pressures() {
    const Volumes begin = solid_.volumes_at(q0_);
    const Volumes end = solid_.volumes_at(q1_);
    for (int cell = 0; cell < solid_.elements().n_cells(); ++cell) {
      const double J = dt_ > 0.0 ? 0.5 * (begin.J[cell] + end.J[cell]) : end.J[cell];
      solid_.pressures(y_)[cell] = solid_.dilation(cell, J).pressure;
    }
  }

  const model::Model& model_;
  const Solid& solid_;
  double dt_;
  VectorXd q0_, q1_, q_, v_, y_, dq_, dy_;
  model::IntervalForces forces_;
};

TEST(SolidAction, IsTheDerivativeOfTheEquations) {
  for (const Formulation formulation : test::formulations) {
    for (const double dt : {0.0, 0.3}) {
      const auto model = test::make_model(everything(formulation));
      Equations equations(*model, dt);
      const double h = 1e-4;
      // Differences of fourth order.
      const VectorXd difference =
          (8.0 * (equations.rows(h) - equations.rows(-h)) - (equations.rows(2 * h) - equations.rows(-2 * h))) /
          (12.0 * h);
      const VectorXd exact = equations.action();
      const Eigen::Index n_q = model->n_q();
      const Solid& solid = test::solid_in(*model);
      for (const auto& [first, n] : {std::pair{Eigen::Index{0}, n_q},
                                     {n_q, solid.n_potentials()},
                                     {n_q + solid.n_potentials(), solid.n_pressures()}}) {
        if (n == 0) continue;
        const double size = exact.segment(first, n).lpNorm<Eigen::Infinity>();
        EXPECT_GT(size, 0.0);
        EXPECT_LT((difference + exact).segment(first, n).lpNorm<Eigen::Infinity>(), 1e-9 * size)
            << static_cast<int>(formulation) << ' ' << dt << ' ' << first;
      }
    }
  }
}

TEST(SolidAction, AViscousCubeSpinsByATenthOfARadianAStep) {
  // Without dP_vis/dF Newton's method fails here (numerics 1.3); a rigid turn dissipates nothing.
  const double dt = 1.0;
  const double omega = 0.1 / dt;
  // Mean dilatations at the middle of a step count rotation as a change of volume (numerics C5): not for displacements.
  for (const Formulation formulation : {Formulation::mean_dilatation, Formulation::incompressible}) {
    test::SolidSystem system = test::solid_box({2, 2, 2}, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    Material material = test::rubber(mu, 10.0, formulation);
    material.viscous = KelvinVoigt{.viscosity = 0.5};
    system.fill(material, mu, formulation);
    const auto model = test::make_model(system);
    variational::Stepper stepper(*model, dt, {.tolerance = 1e-11});
    variational::State state = test::moving_state(*model, dt, test::spin(system, {0, 0, omega}));
    // The start stretches under its centrifugal forces, which the viscosity takes up in the first steps.
    double dissipated = 0.0;
    int iterations = 0;
    while (state.step < 60) {
      const variational::StepReport report = stepper.advance(state, {});
      ASSERT_EQ(report.status, variational::Status::running) << report.sentence;
      if (state.step > 40) dissipated = std::max(dissipated, std::abs(report.work.dissipated));
      iterations = std::max(iterations, report.iterations);
    }
    // Relative to what strain rates as large as the spin would dissipate: eta omega^2 V dt.
    EXPECT_LT(dissipated / (0.5 * omega * omega * dt), 1e-12);
    EXPECT_LE(iterations, 12);
    const int corner = system.node_at({0.5, 0.5, 0.5});
    EXPECT_NEAR(state.q.segment<3>(3 * corner).norm(), std::sqrt(0.75), 1e-3);
  }
}

/// Stretch of a cube of Bonet and Wood's material under a pressure: mu (l^2 - 1)/l^3 + lambda ln(l^3)/l^3 = -p.
double stretch_under_pressure(double lambda, double pressure) {
  double low = 0.1, high = 1.0;
  while (high - low > 1e-15) {
    const double l = 0.5 * (low + high);
    const double J = l * l * l;
    ((mu * (l * l - 1.0) + lambda * std::log(J)) / J < -pressure ? low : high) = l;
  }
  return low;
}

TEST(SolidAction, ACubeUnderHydrostaticPressureIsStable) {
  const double pressure = 1.5 * mu;
  const double lambda = 10.0;
  for (const Formulation formulation : {Formulation::displacement, Formulation::incompressible}) {
    test::SolidSystem system = test::solid_box({2, 2, 2}, {0, 0, 0}, {1, 1, 1});
    system.hold_lower_faces();
    for (int i = 0; i < 3; ++i) {
      system.solid.pressures.push_back({.faces = test::faces_in(system, i, 1.0), .value = {.constant = pressure}});
    }
    system.fill(test::rubber(mu, lambda, formulation), mu, formulation);
    const auto model = test::make_model(system);
    statics::StaticState state = test::static_start(*model);
    const statics::EquilibriumReport report = statics::EquilibriumSolver(*model, {}).solve(state, {});
    ASSERT_TRUE(report.converged);
    EXPECT_EQ(report.stability, statics::Stability::stable);
    EXPECT_LE(report.iterations, 6);
    const double stretch = formulation == Formulation::displacement ? stretch_under_pressure(lambda, pressure) : 1.0;
    EXPECT_NEAR(state.q[3 * system.node_at({1, 1, 1})], stretch, 1e-12);
    if (formulation == Formulation::incompressible) {
      // Cauchy stress mu + p = -pressure.
      EXPECT_NEAR(test::solid_in(*model).pressures(state.y)[0], -pressure, 1e-10);
    }
  }
}

TEST(SolidAction, NewtonEndsQuadraticallyUnderAPressureOnAnOpenSurface) {
  test::SolidSystem system = test::solid_box({4, 1, 1}, {0, 0, 0}, {4, 1, 1});
  for (int i = 0; i < 3; ++i) system.hold(test::plane(0, 0.0), i);
  system.solid.pressures.push_back({.faces = test::faces_in(system, 2, 1.0), .value = {.constant = 0.003}});
  system.fill(test::rubber(mu, 10.0, Formulation::mean_dilatation), mu, Formulation::mean_dilatation);
  const auto model = test::make_model(system);
  statics::StaticState state = test::static_start(*model);
  std::vector<double> residuals;
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    state = test::static_start(*model);
    const auto report = statics::EquilibriumSolver(*model, {.tolerance = tolerance}).solve(state, {});
    ASSERT_TRUE(report.converged);
    EXPECT_EQ(report.stability, statics::Stability::stable);
    residuals.push_back(report.residual);
  }
  // An iteration lies between two of them: 1.3e-5, 1.5e-9, 9e-15.
  EXPECT_LT(residuals[1], 1e-3 * residuals[0]);
  EXPECT_LT(residuals[2], 1e-4 * residuals[1]);
  EXPECT_LT(state.q[3 * system.node_at({4, 1, 1}) + 2], 0.9);
}

TEST(FieldPeaks, AreTheLargestOfTheKernelsFieldsAtTheGaussPoints) {
  const auto model = test::make_model(everything(Formulation::mean_dilatation));
  const ElementSet& elements = test::solid_in(*model).elements();
  const VectorXd x = elements.reference() + rough(elements.reference().size(), 0.03, 8);
  const VectorXd phi = rough(elements.n_nodes(), 1e4, 9);
  std::vector<PointValues> points(8 * static_cast<std::size_t>(elements.n_cells()));
  elements.point_values({.x = x.data(), .phi = phi.data()}, points.data());
  VectorXd peaks(elements.n_cells());
  field_peaks(elements, x, phi, peaks);
  for (int cell = 0; cell < elements.n_cells(); ++cell) {
    double largest = 0.0;
    for (std::size_t q = 0; q < 8; ++q) {
      largest = std::max(largest, Vector3d(points[8 * static_cast<std::size_t>(cell) + q].field).norm());
    }
    EXPECT_NEAR(peaks[cell], largest, 1e-12 * largest) << cell;
  }
}

}  // namespace
}  // namespace muldi::fem
