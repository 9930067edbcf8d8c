/// Two-point elements do the work that their potentials lose, and nothing else drives them at rest.
#include <algorithm>
#include <array>
#include <cmath>

#include "derivatives/muscles/battery.hpp"
#include "muscles/two_point_term.hpp"

namespace muldi {
namespace {

using muscles::PointForces;

template <class Element>
class ElementEnergy : public testing::Test {};
TYPED_TEST_SUITE(ElementEnergy, test::TypesOf<muscles::TwoPointTypes>::type);

template <class Element, class State>
double potential(const Element& element, const State& x) {
  const auto energy = muscles::as_energy(element);
  return energy.elastic(x) + energy.electric(x);
}

TYPED_TEST(ElementEnergy, WorkAtRestIsTheLossOfPotential) {
  // Gauss-Legendre rule of three points on 1000 parts of a straight way of both ends.
  constexpr int n_parts = 1000;
  const std::array<double, 3> at{0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
  constexpr std::array<double, 3> weight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  std::mt19937 random(41);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    auto start = test::random_state<TypeParam::n_controls>(random);
    start.v1.setZero();
    start.v2.setZero();
    auto end = start;
    end.a1 += test::random_vector(random, 10.0);
    end.a2 += test::random_vector(random, 10.0);
    muscles::Vector6 way;
    way << end.a1 - start.a1, end.a2 - start.a2;
    double work = 0.0;
    double turnover = 0.0;
    for (int part = 0; part < n_parts; ++part) {
      for (std::size_t g = 0; g < at.size(); ++g) {
        const double s = (part + at[g]) / n_parts;
        auto x = start;
        x.a1 += s * way.head<3>();
        x.a2 += s * way.tail<3>();
        PointForces forces;
        muscles::point_forces(element, x, forces);
        // A force that acts at rest is a drive: its work is external.
        const double drive = muscles::as_energy(element).force(x);
        const double lengthening = (x.a1 - x.a2).normalized().dot(way.head<3>() - way.tail<3>());
        const double share = weight[g] / n_parts * (forces.force.dot(way) - drive * lengthening);
        work += share;
        turnover += std::abs(share);
      }
    }
    EXPECT_NEAR(work, potential(element, start) - potential(element, end), 1e-9 * (1.0 + turnover));
  }
}

TYPED_TEST(ElementEnergy, RestForcesAreOppositeAndAlongTheLine) {
  std::mt19937 random(42);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    auto x = test::random_state<TypeParam::n_controls>(random);
    x.v1.setZero();
    x.v2.setZero();
    PointForces forces;
    muscles::point_forces(element, x, forces);
    const Eigen::Vector3d first = forces.force.template head<3>();
    const Eigen::Vector3d axis = (x.a1 - x.a2).normalized();
    EXPECT_EQ((first + forces.force.template tail<3>()).norm(), 0.0);
    EXPECT_LE(first.cross(axis).norm(), 1e-14 * (1.0 + first.norm()));
    EXPECT_NEAR(muscles::pull(element, x), -first.dot(axis), 1e-12 * (1.0 + first.norm()));
    EXPECT_NEAR(muscles::pull(muscles::as_energy(element), x), -first.dot(axis), 1e-12 * (1.0 + first.norm()));
  }
}

TYPED_TEST(ElementEnergy, MotionOnlyTakesEnergyAndOnlyFromElementsThatSaySo) {
  std::mt19937 random(43);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    const auto energy = muscles::as_energy(element);
    double most = 0.0;
    for (int k = 0; k < 20; ++k) {
      const auto x = test::random_state<TypeParam::n_controls>(random);
      auto rest = x;
      rest.v1.setZero();
      rest.v2.setZero();
      const double power = (energy.force(x) - energy.force(rest)) * x.rate();
      EXPECT_LE(power, 0.0);
      most = std::max(most, -power);
    }
    EXPECT_EQ(most > 0.0, element.dissipates());
  }
}

}  // namespace
}  // namespace muldi
