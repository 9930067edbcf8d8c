/// Interval terms of the muscles: what they scatter into q-space against differences and jets.
#include "derivatives/muscles/battery.hpp"
#include "math/derivative_check.hpp"
#include "muscles/free_actuator_term.hpp"
#include "muscles/two_point_term.hpp"

namespace muldi {
namespace {

using model::IntervalForces;
using model::IntervalPoint;
using model::IntervalTerm;
using model::LinearPoint;
using model::TangentWeights;

/// A body point phi + sum xi_k d_k of the body that owns q[12 body .. 12 body + 12).
LinearPoint body_point(int body, const Eigen::Vector3d& xi) {
  LinearPoint point;
  point.add(body, 12 * body, 1.0);
  for (int k = 0; k < 3; ++k) point.add(body, 12 * body + 3 + 3 * k, xi[k]);
  return point;
}

/// Two bodies in any pose (directors near orthonormal), 24 entries.
Eigen::VectorXd two_bodies(std::mt19937& random) {
  Eigen::VectorXd q(24);
  for (int body = 0; body < 2; ++body) {
    q.segment<3>(12 * body) = Eigen::Vector3d(90.0 * body, 0.0, 0.0) + test::random_vector(random, 10.0);
    const Eigen::Matrix3d rotation = test::random_rotation(random);
    for (int k = 0; k < 3; ++k) q.segment<3>(12 * body + 3 + 3 * k) = rotation.col(k);
  }
  return q;
}

/// Points of both bodies (one with a vanishing coordinate), of ground, and two points of one body.
template <class Element>
muscles::TwoPointTerm<Element> two_body_term() {
  std::vector<muscles::TwoPointComponent<Element>> list;
  const LinearPoint p = body_point(0, {3.0, -4.0, 5.0});
  const LinearPoint q = body_point(1, {0.0, 2.0, 0.0});
  const LinearPoint ground = LinearPoint::constant({-40.0, 50.0, 30.0});
  const std::array<std::pair<LinearPoint, LinearPoint>, 3> ends{{{p, q}, {q, ground}, {ground, p}}};
  for (const Element& element : test::examples<Element>()) {
    for (const auto& [a1, a2] : ends) {
      muscles::TwoPointComponent<Element> component{"e" + std::to_string(list.size()), element, a1, a2};
      for (auto& input : component.controls) input = {.control = static_cast<int>(list.size() % 2), .factor = 100.0};
      list.push_back(component);
    }
  }
  return {std::move(list), Eigen::Vector3d(0.001, -9.81e-3, 0.002)};
}

struct Setting {
  math::BlockPattern pattern;
  Eigen::VectorXd q0, q1;
  std::vector<double> u;
  double dt = 1.0;
};

Setting bind_to(IntervalTerm& term, std::vector<int> sizes) {
  model::PatternRequest request;
  term.request(request);
  Setting setting{math::BlockPattern(std::move(sizes), request.pairs()), {}, {}, {300.0, 200.0}, 0.8};
  term.bind(setting.pattern);
  return setting;
}

IntervalForces forces(const IntervalTerm& term, const Setting& at, const Eigen::VectorXd& q1,
                      const std::vector<double>& u) {
  const Eigen::VectorXd q = 0.5 * (at.q0 + q1);
  const Eigen::VectorXd v = (q1 - at.q0) / at.dt;
  IntervalForces out{Eigen::VectorXd::Zero(q.size()), Eigen::VectorXd::Zero(q.size())};
  term.add_forces(IntervalPoint{at.q0, q1, q, v, u, at.dt}, out);
  return out;
}

/// The Newton matrix of a step is the derivative of dL/dv - dt/2 (dL/dq + f) by q1.
void expect_step_tangent(const IntervalTerm& term, const Setting& at, const Eigen::VectorXd& steps) {
  const auto residual = [&](const Eigen::VectorXd& q1) -> Eigen::VectorXd {
    const IntervalForces out = forces(term, at, q1, at.u);
    return out.momentum - 0.5 * at.dt * out.force;
  };
  const Eigen::MatrixXd reference = math::difference_jacobian(residual, at.q1, steps);
  math::BlockMatrix K(at.pattern);
  const Eigen::VectorXd q = 0.5 * (at.q0 + at.q1);
  const Eigen::VectorXd v = (at.q1 - at.q0) / at.dt;
  term.add_tangent(IntervalPoint{at.q0, at.q1, q, v, at.u, at.dt}, TangentWeights::step(at.dt), K);
  EXPECT_LE(math::derivative_error(K.dense(), reference).relative, 1e-9);
}

void expect_control_force(const IntervalTerm& term, const Setting& at) {
  const Eigen::VectorXd q = 0.5 * (at.q0 + at.q1);
  const Eigen::VectorXd v = (at.q1 - at.q0) / at.dt;
  for (int c = 0; c < 2; ++c) {
    const auto force = [&](const Eigen::VectorXd& value) -> Eigen::VectorXd {
      std::vector<double> u = at.u;
      u[static_cast<std::size_t>(c)] = value[0];
      return forces(term, at, at.q1, u).force;
    };
    Eigen::VectorXd given = Eigen::VectorXd::Zero(at.q0.size());
    term.add_control_force(IntervalPoint{at.q0, at.q1, q, v, at.u, at.dt}, c, given);
    const Eigen::VectorXd centre = Eigen::VectorXd::Constant(1, at.u[static_cast<std::size_t>(c)]);
    const auto reference = math::difference_jacobian(force, centre, Eigen::VectorXd::Constant(1, 10.0));
    EXPECT_LE((given - reference.col(0)).norm(), 1e-9 * (1.0 + reference.norm()));
  }
}

template <class Element>
class TwoPointTermTest : public testing::Test {};
TYPED_TEST_SUITE(TwoPointTermTest, test::TypesOf<muscles::TwoPointTypes>::type);

TYPED_TEST(TwoPointTermTest, TangentIsTheDerivativeOfTheForces) {
  std::mt19937 random(21);
  auto term = two_body_term<TypeParam>();
  Setting at = bind_to(term, {12, 12});
  for (int k = 0; k < 5; ++k) {
    at.q0 = two_bodies(random);
    at.q1 = at.q0 + 0.02 * Eigen::VectorXd::Random(24);
    Eigen::VectorXd steps = Eigen::VectorXd::Constant(24, 0.5);
    for (int body = 0; body < 2; ++body) steps.segment<9>(12 * body + 3).setConstant(0.1);
    expect_step_tangent(term, at, steps);
    expect_control_force(term, at);
  }
}

TYPED_TEST(TwoPointTermTest, TangentIsTheOneOfJetsThroughTheDensePointMaps) {
  std::mt19937 random(22);
  auto term = two_body_term<TypeParam>();
  Setting at = bind_to(term, {12, 12});
  at.q0 = two_bodies(random);
  at.q1 = at.q0 + 0.02 * Eigen::VectorXd::Random(24);
  const Eigen::VectorXd q = 0.5 * (at.q0 + at.q1);
  const Eigen::VectorXd v = (at.q1 - at.q0) / at.dt;
  const TangentWeights weights{.vv = 0.7, .vq = 0.4, .qv = -0.3, .qq = -0.9};
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(24, 24);
  for (const auto& component : term.components()) {
    Eigen::MatrixXd A(6, 24);
    for (int j = 0; j < 24; ++j) {
      const Eigen::VectorXd unit = Eigen::VectorXd::Unit(24, j);
      A.col(j) << component.a1.rate(unit), component.a2.rate(unit);
    }
    muscles::Matrix6 H;
    muscles::point_tangent(muscles::as_energy(component.element), component.state(q, v, at.u), weights, H);
    expected += A.transpose() * H * A;
  }
  math::BlockMatrix K(at.pattern);
  term.add_tangent(IntervalPoint{at.q0, at.q1, q, v, at.u, at.dt}, weights, K);
  EXPECT_LE(math::derivative_error(K.dense(), expected).relative, 1e-11);
}

TYPED_TEST(TwoPointTermTest, KineticEnergyIsThatOfTheMassMatrix) {
  std::mt19937 random(23);
  auto term = two_body_term<TypeParam>();
  Setting at = bind_to(term, {12, 12});
  const Eigen::VectorXd q = two_bodies(random);
  const Eigen::VectorXd v = Eigen::VectorXd::Random(24);
  math::BlockMatrix M(at.pattern);
  term.add_tangent(IntervalPoint{q, q, q, v, at.u, at.dt}, TangentWeights::mass(), M);
  std::vector<model::Energy> parts(term.parts().size());
  term.energies({{}, q, v, at.u}, parts);
  double kinetic = 0.0;
  for (const model::Energy& part : parts) kinetic += part.kinetic;
  EXPECT_NEAR(kinetic, 0.5 * v.dot(M.dense() * v), 1e-12 * (1.0 + kinetic));
}

TYPED_TEST(TwoPointTermTest, RestForcesAreTheGradientOfTheEnergies) {
  std::mt19937 random(24);
  auto term = two_body_term<TypeParam>();
  Setting at = bind_to(term, {12, 12});
  at.q0 = two_bodies(random);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(24);
  const auto potential = [&](const Eigen::VectorXd& q) -> Eigen::VectorXd {
    std::vector<model::Energy> parts(term.parts().size());
    term.energies({{}, q, rest, at.u}, parts);
    double sum = 0.0;
    for (const model::Energy& part : parts) sum += part.potential();
    return Eigen::VectorXd::Constant(1, sum);
  };
  Eigen::VectorXd steps = Eigen::VectorXd::Constant(24, 0.5);
  for (int body = 0; body < 2; ++body) steps.segment<9>(12 * body + 3).setConstant(0.1);
  const Eigen::MatrixXd slope = math::difference_jacobian(potential, at.q0, steps);
  const Eigen::VectorXd force = forces(term, at, at.q0, at.u).force;
  EXPECT_LE(math::derivative_error(force.transpose(), -slope).relative, 1e-9);
}

TEST(FreeActuatorTerm, TangentIsTheDerivativeOfTheForces) {
  std::vector<muscles::FreeActuator> actuators;
  for (const muscles::LumpedDea& element : test::examples<muscles::LumpedDea>()) {
    const int k = static_cast<int>(actuators.size());
    actuators.push_back({"f" + std::to_string(k), element, k, k, {.control = k % 2, .factor = 100.0}});
  }
  muscles::FreeActuatorTerm term(actuators);
  Setting at = bind_to(term, std::vector<int>(actuators.size(), 1));
  at.q0 = Eigen::VectorXd::Constant(6, 90.0) + Eigen::VectorXd::Random(6) * 10.0;
  at.q1 = at.q0 + Eigen::VectorXd::Random(6) * 0.5;
  expect_step_tangent(term, at, Eigen::VectorXd::Constant(6, 1.0));
  expect_control_force(term, at);
}

}  // namespace
}  // namespace muldi
