/// One step: what it solves, how it converges, how it fails.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "multibody/registry.hpp"
#include "support/linkages.hpp"
#include "support/random_tree.hpp"
#include "support/systems.hpp"
#include "variational/stepper.hpp"

namespace muldi::variational {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

TEST(Stepper, SolvesTheDiscreteEulerLagrangeEquations) {
  // T_n^T [D2 L_d(n-1) + D1 L_d(n)] = 0 with the momentum form taken apart again, for the pendulum of numerics 1.5.
  const auto model = test::make_model(test::pendulum());
  const double dt = 10.0;
  Stepper stepper(*model, dt, {.tolerance = 1e-13});
  State state = test::state_at_rest(*model);
  std::array<VectorXd, 3> q;
  for (auto& at : q) {
    at = state.q;
    ASSERT_EQ(stepper.advance(state, {}).status, Status::running);
  }
  VectorXd M(12);  // m, and the Euler tensor of (1e5, 3.17e5, 3.17e5)
  M << 40, 40, 40, 2.67e5, 2.67e5, 2.67e5, 5e4, 5e4, 5e4, 5e4, 5e4, 5e4;
  VectorXd weight = VectorXd::Zero(12);
  weight[1] = -40.0 * test::earth_gravity;
  const VectorXd residual = M.cwiseProduct(2.0 * q[1] - q[0] - q[2]) / dt + dt * weight;
  const double angle = std::atan2(q[1][4], q[1][3]);
  const VectorXd T = test::dense_null_space(test::manifold_of(*model), VectorXd::Constant(1, angle)).col(0);
  EXPECT_LT(std::abs(T.dot(residual)), 1e-10 * std::abs(T.dot(dt * weight)));
}

TEST(Stepper, ConvergesQuadratically) {
  // Errors after k iterations, by stopping ever later; dimensionless, hence e_(k+1) ~ e_k^2.
  for (const test::RigidSystem& system :
       {test::double_pendulum(), test::trunk(test::odd_fields(3e4)), test::four_bar({}, test::earth_gravity)}) {
    const auto model = test::make_model(system);
    const double dt = 20.0;
    std::vector<double> u(model->controls.size());
    model->evaluate_controls(0.0, u);
    State exact = test::state_at_rest(*model);
    Stepper fine(*model, dt, {.tolerance = 1e-13});
    ASSERT_EQ(fine.advance(exact, u).status, Status::running);
    std::map<int, double> errors;
    for (double tolerance = 1.0; tolerance > 1e-12; tolerance *= 0.5) {
      State state = test::state_at_rest(*model);
      Stepper stepper(*model, dt, {.tolerance = tolerance});
      const StepReport report = stepper.advance(state, u);
      ASSERT_EQ(report.status, Status::running);
      errors[report.iterations] = (state.q - exact.q).lpNorm<Eigen::Infinity>() / system.length;
    }
    ASSERT_GE(errors.size(), 2u);
    for (auto at = errors.begin(); std::next(at) != errors.end(); ++at) {
      EXPECT_LT(std::next(at)->second, 3.0 * at->second * at->second + 1e-14) << "after " << std::next(at)->first;
    }
    EXPECT_LE(errors.rbegin()->first, 6);
  }
}

TEST(Stepper, TakesTheSameStepWithEverySolver) {
  const auto model = test::make_model(test::trunk(test::odd_fields(3e4)));
  const std::vector<double> u = test::odd_fields(3e4);
  std::vector<VectorXd> ends;
  for (const std::string kind : {"tree", "dense", "bordered"}) {
    Stepper stepper(*model, 5.0, {.linear = kind});
    State state = test::state_at_rest(*model);
    for (int n = 0; n < 50; ++n) ASSERT_EQ(stepper.advance(state, u).status, Status::running);
    ends.push_back(state.q);
  }
  EXPECT_LT((ends[1] - ends[0]).norm(), 1e-10 * ends[0].norm());
  EXPECT_LT((ends[2] - ends[0]).norm(), 1e-10 * ends[0].norm());
}

TEST(Stepper, CountsTimeInWholeSteps) {
  const auto model = test::make_model(test::pendulum());
  Stepper stepper(*model, 0.1, {});
  State state = test::state_at_rest(*model);
  for (int n = 0; n < 1000; ++n) ASSERT_EQ(stepper.advance(state, {}).status, Status::running);
  EXPECT_EQ(state.step, 1000);
  EXPECT_EQ(state.t, 1000 * 0.1) << "a product, not a sum";
}

TEST(Stepper, RefusesAStepThatTurnsABodyTooFar) {
  const auto model = test::make_model(test::pendulum(0.0));
  const State start = test::state_at(*model, VectorXd::Zero(1), VectorXd::Constant(1, 0.05));
  State state = start;
  Stepper stepper(*model, 10.0, {.refuse_rotation = 0.4});
  const StepReport report = stepper.advance(state, {});
  EXPECT_EQ(report.status, Status::step_too_large);
  EXPECT_EQ(report.sentence, "a body turns by 0.524 rad in one step (limit 0.4): use a smaller step");
  EXPECT_EQ(state.q, start.q);
  EXPECT_EQ(state.p, start.p);
  EXPECT_EQ(state.step, 0);
}

TEST(Stepper, TurnsAFreelySpinningBodyByTheDiscreteRate) {
  // Midpoint: the momentum J w is J sin(a)/dt for a turn a a step, so that a = asin(w dt).
  const auto model = test::make_model(test::pendulum(0.0));
  for (const double rate_dt : {0.1, 0.5, 0.9}) {
    State state = test::state_at(*model, VectorXd::Zero(1), VectorXd::Constant(1, rate_dt));
    Stepper stepper(*model, 1.0, {});
    const StepReport report = stepper.advance(state, {});
    ASSERT_EQ(report.status, Status::running) << report.sentence;
    EXPECT_NEAR(state.x[0], std::asin(rate_dt), 1e-10);
    EXPECT_NEAR(report.rotation, std::asin(rate_dt), 1e-10);
  }
}

TEST(Stepper, RefusesMomentaThatNoMidpointStepCarries) {
  // sin(a) = w dt has no solution above 1 (numerics 5 no. 23): never a wrong turn, always a status and a sentence.
  const auto model = test::make_model(test::pendulum(0.0));
  for (const double rate_dt : {1.01, 1.5, 2.0, 2.5, 3.0}) {
    const State start = test::state_at(*model, VectorXd::Zero(1), VectorXd::Constant(1, rate_dt));
    State state = start;
    Stepper stepper(*model, 1.0, {});
    const StepReport report = stepper.advance(state, {});
    EXPECT_EQ(report.status, Status::no_convergence) << rate_dt;
    EXPECT_FALSE(report.sentence.empty());
    EXPECT_EQ(state.q, start.q);
  }
}

TEST(Stepper, CountsTurnsOverManyRevolutions) {
  const auto model = test::make_model(test::pendulum(0.0));
  State state = test::state_at(*model, VectorXd::Zero(1), VectorXd::Constant(1, 0.3));
  Stepper stepper(*model, 1.0, {});
  for (int n = 0; n < 1000; ++n) ASSERT_EQ(stepper.advance(state, {}).status, Status::running);
  EXPECT_NEAR(state.x[0], 1000.0 * std::asin(0.3), 1e-8);  // 48 turns
}

TEST(Stepper, PassesAUniversalJointThroughNinetyDegrees) {
  test::RigidSystem system;
  system.add_body(10.0, Vector3d(500.0, 600.0, 700.0), {.position = Vector3d(0.0, 0.0, 20.0)});
  system.connect(multibody::Universal::pattern, {multibody::ground, 0}, Vector3d::Zero());
  const auto model = test::make_model(system);
  const VectorXd x = VectorXd::Constant(2, 89.9999 * test::degree);
  State state = test::state_at(*model, x, Eigen::Vector2d(0.02, 0.03));
  Stepper stepper(*model, 1.0, {});
  for (int n = 0; n < 300; ++n) {
    const StepReport report = stepper.advance(state, {});
    ASSERT_EQ(report.status, Status::running);
    ASSERT_LE(report.iterations, 6);
    ASSERT_LT(model->manifold->violation(state.q), 1e-14);
  }
  EXPECT_GT(state.x.maxCoeff(), 100.0 * test::degree);
}

TEST(Stepper, HoldsWhatCannotMove) {
  test::RigidSystem system;
  system.gravity = Vector3d(0.0, 0.0, -0.01);
  system.add_body(10.0, Vector3d(1.0, 1.0, 1.0), {});
  system.connect(multibody::Fixed::pattern, {multibody::ground, 0}, Vector3d(5.0, 0.0, 0.0));
  const auto model = test::make_model(system);
  Stepper stepper(*model, 1.0, {});
  State state = test::state_at_rest(*model);
  for (int n = 0; n < 3; ++n) ASSERT_EQ(stepper.advance(state, {}).status, Status::running);
  EXPECT_LT((state.q - test::state_at_rest(*model).q).norm(), 1e-15);
}

TEST(Stepper, ReportsTheChangePointOfAParallelogram) {
  // The crank turns by 0.29 rad a step: no node need be near the change point, but a step passes it.
  const test::FourBar form{.ground = 90.0, .crank = 30.0, .coupler = 90.0, .rocker = 30.0, .crank_angle = 1.0};
  const auto model = test::make_model(test::four_bar(form, 0.0));
  State state = test::state_at(*model, model->manifold->reference(), test::admissible_rates(*model, 0, 0.285));
  Stepper stepper(*model, 1.0, {});
  const int crank = test::manifold_of(*model).tree().link_of(0).first_coordinate;
  int half_turns = 0;
  for (int n = 0; n < 100; ++n) {
    // All bars in line at crank angles of whole half turns.
    const double before = std::floor((state.x[crank] + 1.0) / std::acos(-1.0));
    const StepReport report = stepper.advance(state, {});
    ASSERT_EQ(report.status, Status::running) << report.sentence;
    const double after = std::floor((state.x[crank] + 1.0) / std::acos(-1.0));
    EXPECT_EQ(report.loop_regularity == 0.0, after != before) << "step " << n;
    half_turns += after != before ? 1 : 0;
    ASSERT_LT(model->manifold->violation(state.q), 1e-12);
  }
  EXPECT_GE(half_turns, 8);
}

TEST(Stepper, StopsAtAConfigurationWithoutRank) {
  // The scene pose is regular, the start all but in line.
  const test::FourBar form{.ground = 90.0, .crank = 30.0, .coupler = 90.0, .rocker = 30.0, .crank_angle = 1.0};
  const auto model = test::make_model(test::four_bar(form, 0.0));
  State state = test::state_at_rest(*model);
  const multibody::TreeManifold& manifold = test::manifold_of(*model);
  for (const auto& link : manifold.tree().links) state.x[link.first_coordinate] = link.joint == 1 ? 1.0 : -1.0;
  manifold.configuration(state.x, state.q);
  Stepper stepper(*model, 1.0, {});
  const StepReport report = stepper.advance(state, {});
  EXPECT_EQ(report.status, Status::rank_change);
  EXPECT_EQ(report.sentence, "the loop constraints lose rank: the mechanism is at a change point");
}

TEST(Stepper, StopsWhereTheScenePoseIsAChangePoint) {
  // All bars in line: there the loop has one row, and a step along it opens the loop.
  const test::FourBar form{.ground = 90.0, .crank = 30.0, .coupler = 90.0, .rocker = 30.0, .crank_angle = 0.0};
  const auto model = test::make_model(test::four_bar(form, 0.0));
  const multibody::TreeManifold& manifold = test::manifold_of(*model);
  VectorXd w(3);
  for (const auto& link : manifold.tree().links) w[link.first_rate] = link.joint == 1 ? -0.01 : 0.01;
  State state = test::state_at(*model, manifold.reference(), w);
  Stepper stepper(*model, 1.0, {});
  ASSERT_EQ(stepper.advance(state, {}).status, Status::running);
  const StepReport report = stepper.advance(state, {});
  EXPECT_EQ(report.status, Status::rank_change);
  EXPECT_EQ(report.sentence,
            "the loop constraints have a higher rank than in the scene pose, which is a change point of the mechanism: "
            "give another scene pose");
}

/// First angle of the linkage bennett(1), near one, where two of its rows lose rank.
double rank_lost_at(const multibody::TreeManifold& manifold, std::pair<int, int> rows, double near) {
  const auto regularity = [&](double angle) {
    const VectorXd x = test::bennett_coordinates(manifold, 1.0, angle);
    const Eigen::MatrixXd B = test::dense_jacobian(manifold.loop_rows(), test::configuration_at(manifold, x)) *
                              test::dense_null_space(manifold, x);
    const Vector3d a = B.row(rows.first);
    const Vector3d b = B.row(rows.second);
    return a.cross(b).norm() / std::max(a.squaredNorm(), b.squaredNorm());
  };
  double low = near - 0.1;
  double high = near + 0.1;
  for (int i = 0; i < 80; ++i) {
    const double third = (high - low) / 3.0;
    if (regularity(low + third) < regularity(high - third)) {
      high -= third;
    } else {
      low += third;
    }
  }
  EXPECT_LT(regularity(0.5 * (low + high)), 1e-7);
  return 0.5 * (low + high);
}

TEST(Stepper, PassesWhereTwoRowsOfARegularLoopLoseRank) {
  // The rows that are best in the scene pose, and others; angles from a scan of the turn.
  const auto model = test::make_model(test::bennett(1.0));
  const multibody::TreeManifold& manifold = test::manifold_of(*model);
  using Place = std::pair<std::pair<int, int>, double>;
  for (const auto& [rows, near] : {Place({2, 4}, 2.215), Place({0, 1}, 3.145), Place({3, 4}, 3.145)}) {
    const double angle = rank_lost_at(manifold, rows, near);
    for (const double side : {-1e-4, 0.0, 1e-4}) {
      const VectorXd x = test::bennett_coordinates(manifold, 1.0, angle + side);
      State state = test::state_at(*model, x, test::admissible_rates(*model, x, 0, 0.01));
      Stepper stepper(*model, 1.0, {});
      for (int n = 0; n < 20; ++n) {
        const StepReport report = stepper.advance(state, {});
        ASSERT_EQ(report.status, Status::running) << report.sentence;
        ASSERT_GT(report.loop_regularity, 0.4);
        ASSERT_LE(report.iterations, 5);
        ASSERT_LT(manifold.violation(state.q), 1e-13);
      }
    }
  }
}

TEST(Stepper, GoesOnWithTheSameBitsOnALoop) {
  const auto model = test::make_model(test::bennett(1.0));
  State state = test::state_at(*model, model->manifold->reference(), test::admissible_rates(*model, 0, 0.05));
  Stepper stepper(*model, 1.0, {});
  State kept;
  for (int n = 0; n < 300; ++n) {  // more than two turns
    if (n == 117) {
      // What a checkpoint holds.
      kept = {.step = state.step,
              .x = state.x,
              .q = test::configuration_at(*model->manifold, state.x),
              .p = state.p,
              .increment = state.increment,
              .multipliers = state.multipliers};
    }
    ASSERT_EQ(stepper.advance(state, {}).status, Status::running);
  }
  Stepper again(*model, 1.0, {});
  while (kept.step < state.step) ASSERT_EQ(again.advance(kept, {}).status, Status::running);
  EXPECT_EQ(kept.x, state.x);
  EXPECT_EQ(kept.p, state.p);
  EXPECT_EQ(kept.multipliers, state.multipliers);
  EXPECT_EQ(stepper.constraint_force(), again.constraint_force());
}

TEST(Stepper, ReportsACollapsedMuscle) {
  // Far above the dynamic pull-in of 54.6 kV/mm (numerics 3.1) the membrane runs away.
  const auto model = test::make_model(test::membrane(9e4, 0.0));
  State state = test::state_at_rest(*model);
  Stepper stepper(*model, 0.01, {});
  const std::vector<double> u{9e4};
  StepReport report;
  for (int n = 0; n < 1000 && report.status == Status::running; ++n) report = stepper.advance(state, u);
  EXPECT_EQ(report.status, Status::muscle_collapse);
  EXPECT_EQ(report.sentence.substr(0, 27), "muscle 'membrane': stretch ");
  EXPECT_LT(state.q[0], 0.5);
  EXPECT_GE(state.q[0], 0.2);
}

TEST(Stepper, TakesMassRatiosOfAMillion) {
  // Two spherical pendulums; ten times finer steps tell the right answer to 1e-4 (numerics 5 no. 18).
  for (const double ratio : {1e-6, 1e6}) {
    test::RigidSystem system;
    system.gravity = Vector3d(0.0, 0.0, -test::earth_gravity);
    system.add_body(1.0, Vector3d(500.0, 600.0, 700.0), {.position = Vector3d(30.0, 0.0, 0.0)});
    system.add_body(ratio, ratio * Vector3d(500.0, 600.0, 700.0), {.position = Vector3d(60.0, 30.0, 0.0)});
    system.connect(multibody::Spherical::pattern, {multibody::ground, 0}, Vector3d::Zero());
    system.connect(multibody::Revolute::pattern, {0, 1}, Vector3d(60.0, 0.0, 0.0));
    const auto model = test::make_model(system);
    const auto end = [&](double dt, int steps) {
      State state = test::state_at_rest(*model);
      Stepper stepper(*model, dt, {});
      for (int n = 0; n < steps; ++n) {
        const StepReport report = stepper.advance(state, {});
        EXPECT_EQ(report.status, Status::running) << report.sentence;
      }
      EXPECT_LT(model->manifold->violation(state.q), 1e-10);
      return state.q;
    };
    EXPECT_LT((end(0.2, 500) - end(0.02, 5000)).lpNorm<Eigen::Infinity>(), 1e-4 * system.length) << ratio;
  }
}

}  // namespace
}  // namespace muldi::variational
