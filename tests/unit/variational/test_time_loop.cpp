/// The loop around the steps: what it records, when it stops, the ledger, going on from a checkpoint.
#include <gtest/gtest.h>

#include <cmath>

#include "multibody/registry.hpp"
#include "support/figure.hpp"
#include "support/linkages.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi::variational {
namespace {

using Eigen::VectorXd;

TEST(TimeLoop, RecordsEveryNodeOnce) {
  const auto model = test::make_model(test::pendulum());
  std::vector<long> steps;
  std::vector<double> times;
  const test::Run run =
      test::run(*model, test::state_at_rest(*model), {.dt = 0.5, .steps = 4}, [&](const NodeRecord& node) {
        steps.push_back(node.step);
        times.push_back(node.t);
        EXPECT_EQ(node.state.step, node.step);
      });
  EXPECT_EQ(steps, (std::vector<long>{0, 1, 2, 3, 4}));
  EXPECT_EQ(times, (std::vector<double>{0.0, 0.5, 1.0, 1.5, 2.0}));
  EXPECT_EQ(run.result.status, Status::completed);
  EXPECT_EQ(run.result.t, 2.0);
  EXPECT_EQ(run.result.statistics.steps, 4);
  EXPECT_EQ(run.result.statistics.iterations, run.result.statistics.factorisations);
}

TEST(TimeLoop, RecordsEveryThirdNodeAndTheLast) {
  const auto model = test::make_model(test::pendulum());
  TimeLoop loop(*model, {.dt = 0.5, .steps = 7, .record_every = 3});
  std::vector<long> steps;
  State state = test::state_at_rest(*model);
  Ledger ledger;
  StepReport last;
  static_cast<void>(
      loop.run(state, ledger, last, {.record = [&](const NodeRecord& node) { steps.push_back(node.step); }}));
  EXPECT_EQ(steps, (std::vector<long>{0, 3, 6, 7}));
}

TEST(TimeLoop, WithoutStepsRecordsTheStart) {
  const auto model = test::make_model(test::pendulum());
  int n = 0;
  const test::Run run =
      test::run(*model, test::state_at_rest(*model), {.dt = 1.0, .steps = 0}, [&](const NodeRecord& node) {
        ++n;
        EXPECT_EQ(node.values.total.gravity, 0.0);
      });
  EXPECT_EQ(n, 1);
  EXPECT_EQ(run.result.status, Status::completed);
}

TEST(TimeLoop, StopsWhereTheUserInterrupts) {
  const auto model = test::make_model(test::pendulum());
  TimeLoop loop(*model, {.dt = 0.5, .steps = 100});
  State state = test::state_at_rest(*model);
  Ledger ledger;
  StepReport last;
  long recorded = -1;
  const LoopResult result = loop.run(state, ledger, last,
                                     {.record = [&](const NodeRecord& node) { recorded = node.step; },
                                      .interrupted = [&] { return state.step == 5; }});
  EXPECT_EQ(result.status, Status::interrupted);
  EXPECT_EQ(result.sentence, "interrupted by the user");
  EXPECT_EQ(state.step, 5);
  EXPECT_EQ(recorded, 5) << "the node that was reached";
}

TEST(TimeLoop, GoesOnFromACheckpointBitForBit) {
  for (const test::RigidSystem& system : {test::muscle_joint(3e4), test::four_bar({}, test::earth_gravity)}) {
    const auto model = test::make_model(system);
    const LoopOptions options{.dt = 2.0, .steps = 60};
    State at_23;
    Ledger ledger_23;
    StepReport last_23;
    State state = test::state_at_rest(*model);
    Ledger ledger;
    StepReport last;
    TimeLoop loop(*model, options);
    static_cast<void>(loop.run(state, ledger, last,
                               {.record = {}, .checkpoint = [&](const State& s, const Ledger& l, const StepReport& r) {
                                  if (s.step != 23) return;
                                  at_23 = s;
                                  ledger_23 = l;
                                  last_23 = r;
                                }}));
    TimeLoop again(*model, options);
    ASSERT_EQ(at_23.step, 23);
    long first = -1;
    static_cast<void>(again.run(at_23, ledger_23, last_23, {.record = [&](const NodeRecord& node) {
                                  if (first < 0) first = node.step;
                                }}));
    EXPECT_EQ(first, 23) << "the checkpoint's own node is recorded again";
    EXPECT_EQ(at_23.q, state.q);
    EXPECT_EQ(at_23.p, state.p);
    EXPECT_EQ(at_23.t, state.t);
    EXPECT_EQ(ledger_23.dissipated, ledger.dissipated);
    EXPECT_EQ(ledger_23.source, ledger.source);
  }
}

TEST(TimeLoop, RefusesABodyWithoutInertiaThatMoves) {
  // The second body is a point on a ball joint in its own centre: its turns cost nothing (numerics 5 no. 30).
  for (const bool massless : {false, true}) {
    test::RigidSystem system = test::pendulum();
    system.add_body(massless ? 0.0 : 5.0, Eigen::Vector3d::Zero(), {.position = Eigen::Vector3d(92.0, 0.0, 0.0)});
    system.connect(multibody::Spherical::pattern, {0, 1}, Eigen::Vector3d(92.0, 0.0, 0.0));
    const auto model = test::make_model(system);
    const test::Run run = test::run(*model, test::state_at_rest(*model), {.dt = 1.0, .steps = 3});
    EXPECT_EQ(run.result.status, Status::no_convergence);
    EXPECT_EQ(run.result.sentence,
              "the mass matrix is singular on the free motions: a body without mass or inertia moves");
    EXPECT_EQ(run.result.statistics.steps, 0);
  }
}

TEST(TimeLoop, RunsAThinRodWhoseJointForbidsItsOwnAxis) {
  // Zero inertia about its own axis, but the joint turns it about another one.
  test::RigidSystem system = test::pendulum();
  system.bodies[0].inertia = Eigen::Vector3d(0.0, 3.17e5, 3.17e5).asDiagonal();
  const auto model = test::make_model(system);
  const test::Run run = test::run(*model, test::state_at_rest(*model), {.dt = 5.0, .steps = 100});
  EXPECT_EQ(run.result.status, Status::completed);
  const auto thick = test::make_model(test::pendulum());
  const test::Run expected = test::run(*thick, test::state_at_rest(*thick), {.dt = 5.0, .steps = 100});
  test::record_figure("30", "rod without inertia about its own axis against one with, angle after 100 steps (rad)",
                      std::abs(run.state.x[0] - expected.state.x[0]), 1e-10);
}

TEST(TimeLoop, WarnsOnceOfLargeRotations) {
  const auto model = test::make_model(test::pendulum(0.0));
  TimeLoop loop(*model, {.dt = 1.0, .steps = 20});
  State state = test::state_at(*model, VectorXd::Zero(1), VectorXd::Constant(1, 0.7));
  Ledger ledger;
  StepReport last;
  int warnings = 0;
  const LoopResult result =
      loop.run(state, ledger, last, {.record = {}, .warn = [&](const StepReport& report, double t) {
                                       ++warnings;
                                       EXPECT_GT(report.rotation, 0.5);
                                       EXPECT_EQ(t, 1.0);
                                     }});
  EXPECT_EQ(warnings, 1);
  EXPECT_EQ(result.status, Status::completed);
  EXPECT_GT(result.statistics.largest_rotation, 0.7);
}

TEST(TimeLoop, RecordsTheLastGoodNodeOfAFailedRun) {
  const auto model = test::make_model(test::membrane(9e4, 0.0));
  long recorded = -1;
  const test::Run run = test::run(*model, test::state_at_rest(*model), {.dt = 0.01, .steps = 1000},
                                  [&](const NodeRecord& node) { recorded = node.step; });
  EXPECT_EQ(run.result.status, Status::muscle_collapse);
  EXPECT_EQ(recorded, run.state.step);
  EXPECT_EQ(recorded, run.result.statistics.steps);
}

TEST(TimeLoop, BooksTheWorkOfVoltageJumps) {
  // A field that steps from 1 to 3 kV/mm at 0.1 ms: the source gives the enthalpy after minus before at that node.
  test::RigidSystem system = test::membrane(0.0, 0.01);
  system.controls[0].function = base::TimeFunction(base::Samples{.times = {0.0, 0.1}, .values = {1e3, 3e3}});
  const auto model = test::make_model(system);
  double length_at_jump = 0.0;
  const test::Run run =
      test::run(*model, test::state_at_rest(*model), {.dt = 0.01, .steps = 30}, [&](const NodeRecord& node) {
        if (node.step == 10) length_at_jump = node.state.q[0];
        EXPECT_EQ(node.u[0], node.step <= 10 ? 1e3 : 3e3) << "of the interval that ends";
      });
  const double expected = -0.5 * 400.0 * 3.7 * test::eps0 * (9e6 - 1e6) / (length_at_jump * length_at_jump);
  EXPECT_NEAR(run.ledger.source, expected, 1e-12 * std::abs(expected));
}

TEST(Status, HasTheNamesOfTheResultFile) {
  const std::vector<std::pair<Status, std::string>> names{{Status::running, "running"},
                                                          {Status::completed, "completed"},
                                                          {Status::interrupted, "interrupted"},
                                                          {Status::no_convergence, "no_convergence"},
                                                          {Status::loss_of_equilibrium, "loss_of_equilibrium"},
                                                          {Status::muscle_collapse, "muscle_collapse"},
                                                          {Status::breakdown, "breakdown"},
                                                          {Status::step_too_large, "step_too_large"},
                                                          {Status::rank_change, "rank_change"},
                                                          {Status::write_error, "write_error"}};
  for (const auto& [status, name] : names) EXPECT_EQ(name_of(status), name);
}

}  // namespace
}  // namespace muldi::variational
