/// The chain rule from the axial functions to the twelve point coordinates against jets over the points.
#include <cmath>
#include <string>
#include <vector>

#include "derivatives/muscles/battery.hpp"
#include "math/derivative_check.hpp"
#include "muscles/two_point_term.hpp"

namespace muldi {
namespace {

using model::TangentWeights;
using muscles::Matrix6;
using muscles::PointForces;

template <class Element>
class TwoPointElementTest : public testing::Test {};
TYPED_TEST_SUITE(TwoPointElementTest, test::TypesOf<muscles::TwoPointTypes>::type);

TYPED_TEST(TwoPointElementTest, ForcesAreThoseOfTheEnergies) {
  std::mt19937 random(11);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    for (int k = 0; k < 20; ++k) {
      const auto x = test::random_state<TypeParam::n_controls>(random);
      PointForces hand;
      PointForces jets;
      muscles::point_forces(element, x, hand);
      muscles::point_forces(muscles::as_energy(element), x, jets);
      EXPECT_LE(math::derivative_error(hand.force, jets.force).relative, 1e-11);
      EXPECT_LE(math::derivative_error(hand.momentum, jets.momentum).relative, 1e-11);
    }
  }
}

TYPED_TEST(TwoPointElementTest, EverySecondDerivativeIsThatOfTheEnergies) {
  std::mt19937 random(12);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    for (int k = 0; k < 20; ++k) {
      const auto x = test::random_state<TypeParam::n_controls>(random);
      for (const TangentWeights& weights : {TangentWeights{.vv = 1.0}, TangentWeights{.vq = 1.0},
                                            TangentWeights{.qv = 1.0}, TangentWeights{.qq = 1.0}}) {
        Matrix6 hand;
        Matrix6 jets;
        muscles::point_tangent(element, x, weights, hand);
        muscles::point_tangent(muscles::as_energy(element), x, weights, jets);
        EXPECT_LE(math::derivative_error(hand, jets).relative, 1e-11);
      }
    }
  }
}

TYPED_TEST(TwoPointElementTest, ControlForcesAreThoseOfTheEnergies) {
  std::mt19937 random(13);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    const auto x = test::random_state<TypeParam::n_controls>(random);
    for (int c = 0; c < TypeParam::n_controls; ++c) {
      EXPECT_LE(math::derivative_error(muscles::point_control_force(element, x, c),
                                       muscles::point_control_force(muscles::as_energy(element), x, c))
                    .relative,
                1e-11);
    }
  }
}

TYPED_TEST(TwoPointElementTest, MassAndStiffnessAreSymmetricWithoutForce) {
  std::mt19937 random(14);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    const auto x = test::random_state<TypeParam::n_controls>(random);
    Matrix6 mass;
    muscles::point_tangent(element, x, TangentWeights::mass(), mass);
    EXPECT_LE(math::derivative_error(mass, mass.transpose()).relative, 1e-15);
    auto at_rest = x;
    at_rest.v1.setZero();
    at_rest.v2.setZero();
    Matrix6 stiffness;
    muscles::point_tangent(element, at_rest, TangentWeights::stiffness(), stiffness);
    EXPECT_LE(math::derivative_error(stiffness, stiffness.transpose()).relative, 1e-14);
  }
}

TEST(Spring, WithoutRestLengthIsLinearWhereItsEndsCoincide) {
  const muscles::Spring spring{.stiffness = 2.0};
  const muscles::TwoPoint<double, 0> x{{1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}, {0.1, 0.2, 0.3}, {0.0, 0.0, 0.0}};
  PointForces forces;
  muscles::point_forces(spring, x, forces);
  EXPECT_LE(forces.force.norm(), 1e-90);
  Matrix6 stiffness;
  muscles::point_tangent(spring, x, TangentWeights::stiffness(), stiffness);
  Matrix6 expected;
  expected << 2.0 * Eigen::Matrix3d::Identity(), -2.0 * Eigen::Matrix3d::Identity(), -2.0 * Eigen::Matrix3d::Identity(),
      2.0 * Eigen::Matrix3d::Identity();
  EXPECT_LE((stiffness - expected).norm(), 1e-15);
}

/// A research element that no axial form covers: an anchor of the midpoint, air drag on the ends, two controls.
struct Research {
  static constexpr int n_controls = 2;
  static constexpr std::string_view folder = "muscles";
  static constexpr std::string_view noun = "muscle";

  static double mass() { return 0.7; }
  template <class S>
  S kinetic(const muscles::TwoPoint<S, 2>& x) const {
    return 0.3 * S(x.mid_velocity().dot(x.mid_velocity())) * (1.0 + 0.1 * sin(x.length())) + 0.2 * x.rate() * x.rate();
  }
  template <class S>
  S elastic(const muscles::TwoPoint<S, 2>& x) const {
    const muscles::Vector3<S> m = x.midpoint();
    return exp(-0.1 * S(m.dot(m))) + 0.5 * S(x.a1.cross(x.a2).squaredNorm());
  }
  template <class S>
  S electric(const muscles::TwoPoint<S, 2>& x) const {
    return -0.1 * x.e[0] * x.e[0] / (x.length() * x.length()) + 0.05 * x.e[0] * x.e[1];
  }
  template <class S>
  S force(const muscles::TwoPoint<S, 2>& x) const {
    return x.e[1] - 0.4 * x.rate() * sqrt(1.0 + x.rate() * x.rate()) - 0.1 * x.v1(0);
  }
  static bool dissipates() { return true; }
  static std::string inadmissible(double z) { return z < 10.0 ? "too short to be true" : ""; }
};

TEST(FromEnergy, TangentIsTheDerivativeOfTheForces) {
  std::mt19937 random(15);
  for (int k = 0; k < 10; ++k) {
    const auto at = [](const Eigen::VectorXd& y) {
      muscles::TwoPoint<double, 2> x{y.segment<3>(0), y.segment<3>(3), y.segment<3>(6), y.segment<3>(9)};
      x.e = {y[12], y[13]};
      return x;
    };
    const auto forces = [&](const Eigen::VectorXd& y) {
      PointForces out;
      muscles::point_forces(Research{}, at(y), out);
      Eigen::VectorXd both(12);
      both << out.force, out.momentum;
      return both;
    };
    Eigen::VectorXd y(14);
    y << test::random_vector(random, 1.0), test::random_vector(random, 1.0) + Eigen::Vector3d(3.0, 0.0, 0.0),
        test::random_vector(random, 1.0), test::random_vector(random, 1.0), 0.8, -0.6;
    // Extrapolated differences of values of order 10 over steps of 0.02 leave about 1e-10.
    const auto reference = math::difference_jacobian(forces, y, Eigen::VectorXd::Constant(14, 0.02));
    const auto block = [&](const TangentWeights& weights) {
      Matrix6 out;
      muscles::point_tangent(Research{}, at(y), weights, out);
      return out;
    };
    EXPECT_LE(math::derivative_error(block({.qq = 1.0}), reference.block(0, 0, 6, 6)).relative, 1e-9);
    EXPECT_LE(math::derivative_error(block({.qv = 1.0}), reference.block(0, 6, 6, 6)).relative, 1e-9);
    EXPECT_LE(math::derivative_error(block({.vq = 1.0}), reference.block(6, 0, 6, 6)).relative, 1e-9);
    EXPECT_LE(math::derivative_error(block({.vv = 1.0}), reference.block(6, 6, 6, 6)).relative, 1e-9);
    for (int c = 0; c < 2; ++c) {
      EXPECT_LE(
          math::derivative_error(muscles::point_control_force(Research{}, at(y), c), reference.block(0, 12 + c, 6, 1))
              .relative,
          1e-9);
    }
  }
}

TEST(FromEnergy, MakesATermWithSeveralControls) {
  model::LinearPoint particle;
  particle.add(0, 0, 1.0);
  muscles::TwoPointComponent<Research> component{"r", {}, particle, model::LinearPoint::constant({1.0, 2.0, 3.0})};
  component.controls = {muscles::ControlInput{.control = 1}, muscles::ControlInput{.control = 0, .factor = 2.0}};
  muscles::TwoPointTerm<Research> term({component}, Eigen::Vector3d::Zero());
  EXPECT_EQ(term.parts(), std::vector<std::string>{"muscles/r"});
  const Eigen::VectorXd q = Eigen::VectorXd::Zero(3);
  EXPECT_EQ(term.inadmissible(q), "muscle 'r': too short to be true");
  const std::vector<double> u{0.3, 0.7};
  const auto x = component.state(q, q, u);
  EXPECT_EQ(x.e, (muscles::Controls<double, 2>{0.7, 0.6}));
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(3);
  term.add_control_force({q, q, q, q, u, 1.0}, 0, slope);
  const Eigen::Vector3d expected = 2.0 * muscles::point_control_force(Research{}, x, 1).head<3>();
  EXPECT_EQ(slope, Eigen::VectorXd(expected));
  // At rest the force of the second control is a drive: its work is external.
  const Eigen::VectorXd v{{1.0, 0.0, 0.0}};
  const model::IntervalWork work = term.work({q, q, q, v, u, 0.5});
  const double rate = -1.0 / std::sqrt(14.0);  // n = -(1, 2, 3)/sqrt(14)
  EXPECT_NEAR(work.external, 0.5 * 0.6 * rate, 1e-15);
  EXPECT_NEAR(work.dissipated, 0.5 * (0.4 * rate * std::sqrt(1.0 + rate * rate) + 0.1) * rate, 1e-15);
}

}  // namespace
}  // namespace muldi
