/// Tangents of bodies, loads and forces of loop-closing joints against differences of their forces, for every weight;
/// those of tree joints against differences by the coordinates.
#include <gtest/gtest.h>

#include "math/derivative_check.hpp"
#include "math/rotation.hpp"
#include "multibody/registry.hpp"
#include "support/random_tree.hpp"

namespace muldi::multibody {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// All that a joint force can be, always outside its stops.
test::CoordinateForce outside_stops(int joint, std::size_t motion) {
  return {.joint = joint,
          .motion = motion,
          .stiffness = 0.3,
          .rest = 0.2,
          .damping = 0.7,
          .stops = {.lower = 100.0, .upper = 101.0, .stiffness = 0.9, .damping = 0.4},
          .control = 0,
          .control_factor = 1.7,
          .constant = 0.6};
}

/// Two bodies with one of everything; every scalar motion of every joint carries a spring, a damper, stops and a drive.
test::RigidSystem everything(std::mt19937& random) {
  test::RigidSystem system;
  for (int i = 0; i < 2; ++i) {
    system.add_body(3.0, Eigen::Vector3d::Zero(), test::random_pose(random, 10.0));
    const Eigen::Matrix3d axes = test::random_rotation(random);
    system.bodies.back().inertia = axes * Eigen::Vector3d(30.0, 40.0, 50.0).asDiagonal() * axes.transpose();
  }
  system.gravity = Eigen::Vector3d(0.1, 0.2, -0.3);
  for (const auto& ends : {std::pair(0, 1), std::pair(ground, 0), std::pair(1, ground)}) {
    for (const JointPattern& pattern : test::joint_patterns()) {
      const int joint = system.connect(pattern, ends, test::random_vector(random, 10.0), test::random_rotation(random));
      for (std::size_t motion = 0; motion < pattern.motions.size(); ++motion) {
        if (pattern.motions[motion].kind == Motion::Kind::ball) continue;
        system.joint_forces.push_back(outside_stops(joint, motion));
      }
    }
  }
  for (const Load::Frame frame : {Load::Frame::world, Load::Frame::body}) {
    for (const Load::Kind kind : {Load::Kind::force, Load::Kind::torque}) {
      system.loads.push_back({.name = "l",
                              .kind = kind,
                              .frame = frame,
                              .body = 1,
                              .point = test::random_vector(random, 5.0),
                              .direction = test::random_vector(random, 1.0),
                              .control = 1,
                              .control_factor = 2.0});
    }
  }
  system.controls.assign(2, {.name = "u", .unit = base::dimension::none, .function = 0.8});
  return system;
}

struct At {
  std::unique_ptr<model::Model> model;
  VectorXd q;
  VectorXd v;
  std::vector<double> u{0.8, -0.5};

  explicit At(std::mt19937& random) {
    // The terms do not know the manifold: its loops need not even be feasible.
    test::RigidSystem system = everything(random);
    model = test::make_model(system);
    // Near the scene pose: midpoint directors are not orthonormal, and no angle is near its singular opposite.
    q = test::configuration_at(*model->manifold, model->manifold->reference());
    for (int body = 0; body < 2; ++body) {
      q.segment<3>(12 * body) += test::random_vector(random, 5.0);
      const Eigen::Matrix3d turn = math::rotation_about(test::random_vector(random, 1.0), 0.5);
      for (int k = 3; k < 12; k += 3) {
        q.segment<3>(12 * body + k) = turn * q.segment<3>(12 * body + k) + test::random_vector(random, 0.05);
      }
    }
    v = test::random_entries(random, 24, 0.5);
  }

  model::IntervalForces forces(const VectorXd& q_at, const VectorXd& v_at, std::span<const double> u_at) const {
    model::IntervalForces out{VectorXd(24), VectorXd(24)};
    model->forces({.q0 = q_at, .q1 = q_at, .q = q_at, .v = v_at, .u = u_at}, out);
    return out;
  }
  MatrixXd tangent(const model::TangentWeights& weights) const {
    math::BlockMatrix K(*model->pattern);
    model->tangent({.q0 = q, .q1 = q, .q = q, .v = v, .u = u}, weights, K);
    return K.dense();
  }
  /// Calls use(point) with the interval from q to q1.
  template <class Use>
  auto over_interval(const VectorXd& q1, double dt, const Use& use) const {
    const VectorXd middle = 0.5 * (q + q1);
    const VectorXd mean = (q1 - q) / dt;
    return use(model::IntervalPoint{.q0 = q, .q1 = q1, .q = middle, .v = mean, .u = u, .dt = dt});
  }
};

TEST(MultibodyTerms, TangentsAreTheSlopesOfForcesAndMomenta) {
  // Extrapolated differences of atan2: 1e-10 at the least (see difference_jacobian).
  std::mt19937 random(70);
  const VectorXd h = VectorXd::Constant(24, 4e-3);
  for (int n = 0; n < 4; ++n) {
    const At at(random);
    const auto force_of_q = [&](const VectorXd& q) -> VectorXd { return at.forces(q, at.v, at.u).force; };
    const auto momentum_of_q = [&](const VectorXd& q) -> VectorXd { return at.forces(q, at.v, at.u).momentum; };
    const auto momentum_of_v = [&](const VectorXd& v) -> VectorXd { return at.forces(at.q, v, at.u).momentum; };
    EXPECT_LT(math::derivative_error(at.tangent({.qq = 1.0}), math::difference_jacobian(force_of_q, at.q, h)).relative,
              1e-10);
    EXPECT_LT(
        math::derivative_error(at.tangent({.vv = 1.0}), math::difference_jacobian(momentum_of_v, at.v, h)).relative,
        1e-10);
    EXPECT_EQ(at.tangent({.vq = 1.0}).norm(), 0.0);
    EXPECT_LT(math::difference_jacobian(momentum_of_q, at.q, h).norm(), 1e-10);
    const model::TangentWeights mixed{.vv = 0.3, .vq = 0.2, .qq = 1.1};
    const MatrixXd sum = 0.3 * at.tangent({.vv = 1.0}) + 1.1 * at.tangent({.qq = 1.0});
    EXPECT_LT(math::derivative_error(at.tangent(mixed), sum).relative, 1e-13);
  }
}

TEST(MultibodyTerms, TheMatrixOfAStepIsMinusTheSlopeOfItsResidual) {
  std::mt19937 random(75);
  const VectorXd h = VectorXd::Constant(24, 4e-3);
  const double dt = 0.7;
  for (int n = 0; n < 4; ++n) {
    const At at(random);
    const VectorXd q1 = at.q + test::random_entries(random, 24, 0.1);
    const auto residual = [&](const VectorXd& q) -> VectorXd {
      return at.over_interval(q, dt, [&](const model::IntervalPoint& point) -> VectorXd {
        model::IntervalForces out{VectorXd(24), VectorXd(24), VectorXd(24), VectorXd(24)};
        at.model->forces(point, out);
        return out.momentum - 0.5 * dt * out.force - out.begin;
      });
    };
    const MatrixXd K = at.over_interval(q1, dt, [&](const model::IntervalPoint& point) {
      math::BlockMatrix result(*at.model->pattern);
      at.model->tangent(point, model::TangentWeights::step(dt), result);
      return result.dense();
    });
    EXPECT_LT(math::derivative_error(K, math::difference_jacobian(residual, q1, h)).relative, 1e-10);
  }
}

TEST(MultibodyTerms, AnIntervalAtRestHasHalfTheStaticForceOfLoopClosingJointsAtEitherEnd) {
  std::mt19937 random(76);
  test::RigidSystem system = everything(random);
  system.loads.clear();
  system.gravity.setZero();
  At at(random);
  at.model = test::make_model(system);
  const double dt = 0.7;
  model::IntervalForces out{VectorXd(24), VectorXd(24), VectorXd(24), VectorXd(24)};
  at.over_interval(at.q, dt, [&](const model::IntervalPoint& point) { at.model->forces(point, out); });
  EXPECT_EQ(out.force.norm(), 0.0);
  const VectorXd expected = 0.5 * dt * at.forces(at.q, VectorXd::Zero(24), at.u).force;
  EXPECT_GT(expected.norm(), 1.0);
  EXPECT_LT((out.begin - expected).norm(), 1e-12 * expected.norm());
  EXPECT_LT((out.end - expected).norm(), 1e-12 * expected.norm());
}

TEST(MultibodyTerms, ControlForcesAreTheSlopesByTheControls) {
  std::mt19937 random(71);
  const At at(random);
  for (int control = 0; control < 2; ++control) {
    VectorXd slope = VectorXd::Zero(24);
    for (const auto& term : at.model->terms) {
      term->add_control_force({.q0 = at.q, .q1 = at.q, .q = at.q, .v = at.v, .u = at.u}, control, slope);
    }
    std::vector<double> u = at.u;
    u[static_cast<std::size_t>(control)] += 1.0;
    const VectorXd expected = at.forces(at.q, at.v, u).force - at.forces(at.q, at.v, at.u).force;  // linear in u
    EXPECT_LT((slope - expected).norm(), 1e-12 * expected.norm());
  }
}

TEST(MultibodyTerms, ConservativeForcesAreMinusTheSlopeOfTheEnergies) {
  std::mt19937 random(72);
  test::RigidSystem system = everything(random);
  system.loads.clear();
  for (auto& force : system.joint_forces) {
    force.damping = 0.0;
    force.stops.damping = 0.0;
    force.control = -1;
    force.constant = 0.0;
  }
  At at(random);
  at.model = test::make_model(system);
  const VectorXd rest = VectorXd::Zero(24);
  const auto energy = [&](const VectorXd& q) -> VectorXd {
    std::vector<model::Energy> parts(at.model->parts().size());
    at.model->energies({.x = {}, .q = q, .v = rest, .u = at.u}, parts);
    double sum = 0.0;
    for (const model::Energy& part : parts) sum += part.potential();
    return VectorXd::Constant(1, sum);
  };
  const VectorXd slope = math::difference_jacobian(energy, at.q, VectorXd::Constant(24, 4e-3)).transpose();
  EXPECT_LT(math::derivative_error(-at.forces(at.q, rest, at.u).force, slope).relative, 1e-10);
}

/// Forces on the tree joints' coordinates over one interval.
struct OnCoordinates {
  std::unique_ptr<model::Model> model;
  VectorXd x0;
  VectorXd x1;
  VectorXd q;
  std::vector<double> u{0.8};
  double dt = 0.1;

  explicit OnCoordinates(std::mt19937& random) {
    test::RigidSystem system = test::random_forest(random, {.n_bodies = 8, .n_chains = 2});
    for (int joint = 0; joint < static_cast<int>(system.joints.size()); ++joint) {
      const auto motions = system.joints[static_cast<std::size_t>(joint)].pattern.motions;
      for (std::size_t motion = 0; motion < motions.size(); ++motion) {
        if (motions[motion].kind == Motion::Kind::ball) continue;
        system.joint_forces.push_back(outside_stops(joint, motion));
      }
    }
    system.controls.assign(1, {.name = "u", .unit = base::dimension::none, .function = 0.8});
    model = test::make_model(system);
    x0 = test::random_coordinates(random, *model->manifold);
    x1 = test::random_coordinates(random, *model->manifold);
    q = test::configuration_at(*model->manifold, x1);
  }

  model::IntervalPoint point(const VectorXd& begin, const VectorXd& end, double over) const {
    const auto n = static_cast<std::size_t>(begin.size());
    return {.q0 = q, .q1 = q, .q = q, .v = q, .u = u, .dt = over, .x0 = {begin.data(), n}, .x1 = {end.data(), n}};
  }
  VectorXd forces(const model::IntervalPoint& at) const {
    model::IntervalForces out{q, q};
    out.on_rates = VectorXd(model->manifold->n_v());
    model->forces(at, out);
    return out.on_rates;
  }
  MatrixXd tangent(const model::IntervalPoint& at, const model::TangentWeights& weights) const {
    VectorXd diagonal(model->manifold->n_v());
    model->rate_tangent(at, weights, diagonal);
    return diagonal.asDiagonal();
  }
};

TEST(MultibodyTerms, RateTangentsAreTheSlopesOfTheForcesOnTheRates) {
  std::mt19937 random(73);
  for (int n = 0; n < 4; ++n) {
    const OnCoordinates at(random);
    const VectorXd zero = VectorXd::Zero(at.model->manifold->n_v());
    const VectorXd h = VectorXd::Constant(zero.size(), 0.1);  // the forces are linear: no kink is near
    const auto of_step = [&](const VectorXd& w) -> VectorXd {
      VectorXd x = at.x1;
      at.model->manifold->retract(at.x1, w, x);
      return -0.5 * at.dt * at.forces(at.point(at.x0, x, at.dt));
    };
    const MatrixXd step = at.tangent(at.point(at.x0, at.x1, at.dt), model::TangentWeights::step(at.dt));
    ASSERT_GT(step.norm(), 0.0);
    EXPECT_LT(math::derivative_error(step, math::difference_jacobian(of_step, zero, h)).relative, 1e-11);
    const auto at_rest = [&](const VectorXd& w) -> VectorXd {
      VectorXd x = at.x1;
      at.model->manifold->retract(at.x1, w, x);
      return -at.forces(at.point(x, x, 0.0));
    };
    const MatrixXd stiffness = at.tangent(at.point(at.x1, at.x1, 0.0), model::TangentWeights::stiffness());
    EXPECT_LT(math::derivative_error(stiffness, math::difference_jacobian(at_rest, zero, h)).relative, 1e-11);
    EXPECT_EQ(at.tangent(at.point(at.x0, at.x1, at.dt), model::TangentWeights::mass()).norm(), 0.0);
  }
}

TEST(MultibodyTerms, ControlForcesOnRatesAreTheSlopesByTheControls) {
  std::mt19937 random(74);
  OnCoordinates at(random);
  const model::IntervalPoint point = at.point(at.x0, at.x1, at.dt);
  VectorXd slope = VectorXd::Zero(at.model->manifold->n_v());
  for (const auto& term : at.model->terms) term->add_control_force_on_rates(point, 0, slope);
  const VectorXd before = at.forces(point);
  at.u[0] += 1.0;
  const VectorXd expected = at.forces(at.point(at.x0, at.x1, at.dt)) - before;  // linear in u
  ASSERT_GT(expected.norm(), 0.0);
  EXPECT_LT((slope - expected).norm(), 1e-12 * expected.norm());
}

}  // namespace
}  // namespace muldi::multibody
