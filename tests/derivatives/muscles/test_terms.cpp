/// Interval terms of the muscles: what they scatter into q-space against differences and jets.
#include <optional>

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

/// One element between points of both bodies (one with a vanishing coordinate), and between each and ground.
template <class Element>
muscles::TwoPointTerm<Element> two_body_term(const Element& element) {
  std::vector<muscles::TwoPointComponent<Element>> list;
  const LinearPoint p = body_point(0, {3.0, -4.0, 5.0});
  const LinearPoint q = body_point(1, {0.0, 2.0, 0.0});
  const LinearPoint ground = LinearPoint::constant({-40.0, 50.0, 30.0});
  const std::array<std::pair<LinearPoint, LinearPoint>, 3> ends{{{p, q}, {q, ground}, {ground, p}}};
  for (const auto& [a1, a2] : ends) {
    muscles::TwoPointComponent<Element> component{"e" + std::to_string(list.size()), element, a1, a2};
    for (auto& input : component.controls) input = {.control = static_cast<int>(list.size() % 2), .factor = 100.0};
    list.push_back(component);
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
  IntervalForces out;
  out.force = Eigen::VectorXd::Zero(q.size());
  out.momentum = Eigen::VectorXd::Zero(q.size());
  term.add_forces(IntervalPoint{at.q0, q1, q, v, u, at.dt}, out);
  return out;
}

/// Jacobian by differences; nothing where those of half the steps tell another one: the function has a bend between.
template <class Function>
std::optional<Eigen::MatrixXd> smooth_jacobian(const Function& f, const Eigen::VectorXd& x,
                                               const Eigen::VectorXd& steps) {
  Eigen::MatrixXd jacobian = math::difference_jacobian(f, x, steps);
  if (math::derivative_error(jacobian, math::difference_jacobian(f, x, 0.5 * steps)).relative > 1e-9) return {};
  return jacobian;
}

/// The Newton matrix of a step is the derivative of dL/dv - dt/2 (dL/dq + f) by q1. False where there is a bend.
bool expect_step_tangent(const IntervalTerm& term, const Setting& at, const Eigen::VectorXd& steps) {
  const auto residual = [&](const Eigen::VectorXd& q1) -> Eigen::VectorXd {
    const IntervalForces out = forces(term, at, q1, at.u);
    return out.momentum - 0.5 * at.dt * out.force;
  };
  const auto reference = smooth_jacobian(residual, at.q1, steps);
  if (!reference) return false;
  math::BlockMatrix K(at.pattern);
  const Eigen::VectorXd q = 0.5 * (at.q0 + at.q1);
  const Eigen::VectorXd v = (at.q1 - at.q0) / at.dt;
  term.add_tangent(IntervalPoint{at.q0, at.q1, q, v, at.u, at.dt}, TangentWeights::step(at.dt), K);
  EXPECT_LE(math::derivative_error(K.dense(), *reference).relative, 1e-9);
  return true;
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

Eigen::VectorXd difference_steps() {
  Eigen::VectorXd steps = Eigen::VectorXd::Constant(24, 0.5);
  for (int body = 0; body < 2; ++body) steps.segment<9>(12 * body + 3).setConstant(0.1);
  return steps;
}

TYPED_TEST(TwoPointTermTest, TangentIsTheDerivativeOfTheForces) {
  std::mt19937 random(21);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    auto term = two_body_term(element);
    Setting at = bind_to(term, {12, 12});
    int n_smooth = 0;
    for (int k = 0; k < 10; ++k) {
      at.q0 = two_bodies(random);
      at.q1 = at.q0 + 0.02 * Eigen::VectorXd::Random(24);
      n_smooth += expect_step_tangent(term, at, difference_steps()) ? 1 : 0;
      expect_control_force(term, at);
    }
    EXPECT_GE(n_smooth, 3);
  }
}

TYPED_TEST(TwoPointTermTest, TangentIsTheOneOfJetsThroughTheDensePointMaps) {
  std::mt19937 random(22);
  const TangentWeights weights{.vv = 0.7, .vq = 0.4, .qv = -0.3, .qq = -0.9};
  for (const TypeParam& element : test::examples<TypeParam>()) {
    auto term = two_body_term(element);
    Setting at = bind_to(term, {12, 12});
    at.q0 = two_bodies(random);
    at.q1 = at.q0 + 0.02 * Eigen::VectorXd::Random(24);
    const Eigen::VectorXd q = 0.5 * (at.q0 + at.q1);
    const Eigen::VectorXd v = (at.q1 - at.q0) / at.dt;
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
}

TYPED_TEST(TwoPointTermTest, KineticEnergyIsThatOfTheMassMatrix) {
  std::mt19937 random(23);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    auto term = two_body_term(element);
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
}

TYPED_TEST(TwoPointTermTest, RestForcesAreTheGradientOfTheEnergies) {
  std::mt19937 random(24);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    auto term = two_body_term(element);
    Setting at = bind_to(term, {12, 12});
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(24);
    const auto potential = [&](const Eigen::VectorXd& q) -> Eigen::VectorXd {
      std::vector<model::Energy> parts(term.parts().size());
      term.energies({{}, q, rest, at.u}, parts);
      double sum = 0.0;
      for (const model::Energy& part : parts) sum += part.potential();
      return Eigen::VectorXd::Constant(1, sum);
    };
    int n_smooth = 0;
    for (int k = 0; k < 3; ++k) {
      at.q0 = two_bodies(random);
      const auto slope = smooth_jacobian(potential, at.q0, difference_steps());
      if (!slope) continue;
      ++n_smooth;
      Eigen::VectorXd force = forces(term, at, at.q0, at.u).force;
      for (const auto& component : term.components()) {  // a force that acts at rest is a drive
        const auto x = component.state(at.q0, rest, at.u);
        const Eigen::Vector3d drive = muscles::as_energy(element).force(x) * (x.a1 - x.a2).normalized();
        component.a1.add_transposed(-drive, force);
        component.a2.add_transposed(drive, force);
      }
      EXPECT_LE(math::derivative_error(force.transpose(), -*slope).relative, 1e-9);
    }
    EXPECT_GE(n_smooth, 1);
  }
}

template <class Element>
class FreeActuatorTermTest : public testing::Test {};
TYPED_TEST_SUITE(FreeActuatorTermTest, test::TypesOf<muscles::MuscleElements>::type);

template <class Element>
muscles::FreeActuatorTerm<Element> free_actuators(const std::vector<Element>& elements) {
  std::vector<muscles::FreeActuator<Element>> actuators;
  for (const Element& element : elements) {
    const int k = static_cast<int>(actuators.size());
    muscles::FreeActuator<Element> actuator{"f" + std::to_string(k), element, k, k};
    for (auto& input : actuator.controls) input = {.control = k % 2, .factor = 100.0};
    actuators.push_back(actuator);
  }
  return muscles::FreeActuatorTerm<Element>(std::move(actuators));
}

TYPED_TEST(FreeActuatorTermTest, TangentIsTheDerivativeOfTheForces) {
  auto term = free_actuators(test::examples<TypeParam>());
  const auto n = static_cast<Eigen::Index>(term.actuators().size());
  Setting at = bind_to(term, std::vector<int>(term.actuators().size(), 1));
  int n_smooth = 0;
  for (int k = 0; k < 5; ++k) {
    at.q0 = Eigen::VectorXd::Constant(n, 90.0) + Eigen::VectorXd::Random(n) * 10.0;
    at.q1 = at.q0 + Eigen::VectorXd::Random(n) * 0.5;
    n_smooth += expect_step_tangent(term, at, Eigen::VectorXd::Constant(n, 1.0)) ? 1 : 0;
    expect_control_force(term, at);
  }
  EXPECT_GE(n_smooth, 1);
}

TYPED_TEST(FreeActuatorTermTest, IsTheElementWhoseEndsMoveAgainstEachOther) {
  std::mt19937 random(25);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    auto x = test::random_state<TypeParam::n_controls>(random);
    const Eigen::Vector3d axis = (x.a1 - x.a2).normalized();
    const double zd = 0.7;
    x.v1 = 0.5 * zd * axis;
    x.v2 = -x.v1;
    muscles::PointForces expected;
    muscles::point_forces(element, x, expected);
    const muscles::Isolated<TypeParam> isolated{element};
    const auto d = muscles::axial_derivatives(isolated, x.length(), zd, x.e);
    const auto along = [&](const Eigen::VectorXd& both) { return 0.5 * axis.dot(both.head<3>() - both.tail<3>()); };
    EXPECT_NEAR(d.l_z + d.f, along(expected.force), 1e-12 * (1.0 + expected.force.norm()));
    EXPECT_NEAR(d.l_d, along(expected.momentum), 1e-12 * (1.0 + expected.momentum.norm()));
    // The same through the energies of the whole state.
    const muscles::Isolated<decltype(muscles::as_energy(element))> readable{muscles::as_energy(element)};
    const auto r = muscles::axial_derivatives(readable, x.length(), zd, x.e);
    const Eigen::Matrix<double, 1, 5> hand(d.l_z, d.l_d, d.l_zz, d.l_dd, d.f), jets(r.l_z, r.l_d, r.l_zz, r.l_dd, r.f);
    EXPECT_LE(math::derivative_error(hand, jets).relative, 1e-11);
  }
}

}  // namespace
}  // namespace muldi
