/// Transients of the isolated actuators through the whole integrator
/// (numerics 3.8, reference-results A).
#include <gtest/gtest.h>

#include <cmath>

#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi::muscles {
namespace {

/// Length at time t, from rest at the reference length.
double length_at(const test::RigidSystem& system, double t, double dt) {
  const auto model = test::make_model(system);
  const test::Run run = test::run(*model, test::state_at_rest(*model), {.dt = dt, .steps = std::lround(t / dt)});
  EXPECT_EQ(run.result.status, variational::Status::completed) << run.result.sentence;
  return run.state.q[0];
}

struct Reference {
  double t;
  double length;
};

/// The error quarters with the step, and extrapolation reaches the reference to
/// `digits`.
void expect_transient(const test::RigidSystem& system, const Reference& reference, double dt, double digits) {
  const double coarse = length_at(system, reference.t, dt);
  const double fine = length_at(system, reference.t, 0.5 * dt);
  const double finest = length_at(system, reference.t, 0.25 * dt);
  EXPECT_NEAR((coarse - reference.length) / (fine - reference.length), 4.0, 0.2) << reference.t;
  // Richardson of the second and fourth order.
  const double limit = (16.0 * test::extrapolated(fine, finest) - test::extrapolated(coarse, fine)) / 15.0;
  EXPECT_NEAR(limit, reference.length, digits) << reference.t;
}

TEST(Actuators, MembraneMovesAsTheReference) {
  // DOP853 at rtol 1e-13, eta 0.01, 30 kV/mm: twelve digits printed, eleven
  // asked for.
  const test::RigidSystem system = test::membrane(3e4, 0.01);
  for (const Reference& reference :
       {Reference{0.5, 0.918577123539}, Reference{1.0, 0.979929427116}, Reference{5.0, 0.950429037483}}) {
    expect_transient(system, reference, 0.0025, 1e-11);
  }
}

TEST(Actuators, MembraneHasThePrintedDiscreteLength) {
  EXPECT_NEAR(length_at(test::membrane(3e4, 0.01), 5.0, 0.01), 0.950388186297, 1e-11);
}

TEST(Actuators, RoundActuatorMovesAsTheReference) {
  expect_transient(test::round_actuator(3e4, 0.01), {5.0, 38.1579462039}, 0.01, 2e-9);
  expect_transient(test::round_actuator(3e4, 0.5), {5.0, 38.1666794486}, 0.01, 2e-9);
}

TEST(Actuators, OverdampedRoundActuatorSettlesWithoutOvershoot) {
  const auto model = test::make_model(test::round_actuator(3e4, 0.5));
  double lowest = 40.0;
  const test::Run run =
      test::run(*model, test::state_at_rest(*model), {.dt = 0.01, .steps = 2000},
                [&](const variational::NodeRecord& node) { lowest = std::min(lowest, node.state.q[0]); });
  EXPECT_NEAR(run.state.q[0], 38.1491044067, 1e-6);
  EXPECT_GT(lowest, 38.1491043966) << "supercritical: zeta 1.367";
}

TEST(Actuators, OscillateAtTheLinearisedFrequency) {
  // A tenth of a per mille about the equilibrium; omega of numerics 3.8 and the
  // shift omega_d = 2/dt atan(omega dt/2).
  const test::RigidSystem system = test::membrane(3e4, 0.0);
  const auto model = test::make_model(system);
  const double rest = 0.953727609917;
  const double omega = 5.86779812517;
  const double dt = 0.01;
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(1, rest * (1.0 + 1e-5));
  double before = 1.0;
  double first = 0.0;
  double last = 0.0;
  int crossings = 0;
  static_cast<void>(test::run(*model, test::state_at(*model, start, Eigen::VectorXd::Zero(1)),
                              {.dt = dt, .steps = 11000}, [&](const variational::NodeRecord& node) {
                                const double now = node.state.q[0] - rest;
                                if (node.step > 0 && before < 0.0 && now >= 0.0) {
                                  last = node.t - dt * now / (now - before);
                                  if (crossings++ == 0) first = last;
                                }
                                before = now;
                              }));
  const double measured = 2.0 * std::acos(-1.0) * (crossings - 1) / (last - first);
  EXPECT_GT(crossings, 100);
  EXPECT_NEAR(measured, 2.0 / dt * std::atan(0.5 * omega * dt), 2e-5 * omega);
}

/// True if a constant field, switched on at rest, collapses the undamped
/// membrane within 20 ms.
bool collapses(double field) {
  const auto model = test::make_model(test::membrane(field, 0.0));
  const test::Run run = test::run(*model, test::state_at_rest(*model), {.dt = 0.001, .steps = 20000});
  return run.result.status == variational::Status::muscle_collapse;
}

TEST(Actuators, PullInDynamicallyBelowTheStaticField) {
  // E_dyn = 0.941252177639 E* = 54601.6995073 V/mm, independent of inertia
  // (numerics 3.1); bracketed to 0.1 %.
  EXPECT_FALSE(collapses(54601.6995073 * 0.9995));
  EXPECT_TRUE(collapses(54601.6995073 * 1.0005));
}

TEST(Actuators, CollapseAtATimeThatConverges) {
  const auto time_of_collapse = [](double dt) {
    const auto model = test::make_model(test::membrane(6.5e4, 0.0));
    const test::Run run = test::run(*model, test::state_at_rest(*model), {.dt = dt, .steps = std::lround(10.0 / dt)});
    EXPECT_EQ(run.result.status, variational::Status::muscle_collapse);
    return run.result.t;
  };
  // The event falls between nodes: known to a step.
  EXPECT_NEAR(time_of_collapse(0.002), time_of_collapse(0.0005), 0.003);
}

}  // namespace
}  // namespace muldi::muscles
