/// The examples of lib/HOW_TO_ADD.md do what the page says.
#include <gtest/gtest.h>

#include <cmath>

#include "ball_on_rail.hpp"
#include "fem/materials/neo_hookean.hpp"
#include "half_way.hpp"
#include "hardening_spring.hpp"
#include "multibody/joint.hpp"
#include "yeoh.hpp"

namespace muldi {
namespace {

TEST(HowToAddAJoint, ConstraintsAndFreedomsAreSixTogether) {
  using multibody::BallOnRail;
  static_assert(BallOnRail::pattern.n_constraints() + BallOnRail::pattern.n_rates() == 6);
  static_assert(BallOnRail::coordinates[0] == multibody::Coordinate::slide);
  static_assert(BallOnRail::coordinates[3] == multibody::Coordinate::angle);
}

TEST(HowToAddAJoint, MotionsMeetTheConstraints) {
  multibody::Joint joint{.name = "rail",
                         .pattern = multibody::BallOnRail::pattern,
                         .body_a = multibody::ground,
                         .body_b = 0,
                         .rho_b = {4.0, -2.0, 1.0}};
  joint.align({}, {.position = {-4.0, 2.0, -1.0}}, Eigen::Matrix3d::Identity());
  // Slide 7 mm, turn by (0.3, -0.2, 0.5) rad.
  const double reported[] = {7.0, 0.3, -0.2, 0.5};
  double stored[5] = {};
  multibody::stored_coordinates(joint, reported, stored);
  const multibody::Pose pose = multibody::pose_of_b(joint, multibody::relative_pose(joint, stored), {});
  EXPECT_LT((pose.point(joint.rho_b) - Eigen::Vector3d(0.0, 0.0, 7.0)).norm(), 1e-14);
  Eigen::VectorXd q(12);
  q << pose.position, pose.orientation.col(0), pose.orientation.col(1), pose.orientation.col(2);
  const auto rows = multibody::constraint_rows(joint, 1.0);
  ASSERT_EQ(rows.size(), 2U);
  for (const model::Bilinear& row : rows) EXPECT_NEAR(row.value(q), 0.0, 1e-14);
}

TEST(HowToAddAMuscle, ForceAndStiffnessAreThoseOfTheEnergy) {
  const muscles::Hardening spring = muscles::HardeningSpring{.stiffness = 2.0, .hardening = 0.5}.element(10.0);
  // k x + h x^3 at x = 3, and its slope k + 3 h x^2.
  EXPECT_DOUBLE_EQ(muscles::pull(spring, muscles::AxialState<0>{.z = 13.0}), 6.0 + 13.5);
  const auto slopes = muscles::axial_derivatives(spring, 13.0, 0.0, muscles::Controls<double, 0>{});
  EXPECT_DOUBLE_EQ(slopes.l_z, -(6.0 + 13.5));
  EXPECT_DOUBLE_EQ(slopes.l_zz, -(2.0 + 13.5));
}

template <class Law>
fem::Stress<double> stress_of(const Law& law, double stretch) {
  fem::Point<double> at;
  at.F[0][0] = stretch;
  at.F[1][1] = at.F[2][2] = 1.0 / std::sqrt(stretch);
  at.complete();
  fem::Stress<double> stress;
  law.add_stress(at, stress);
  return stress;
}

TEST(HowToAddAMaterial, ReferenceIsFreeOfStress) {
  const fem::Yeoh law(fem::YeohEnergy{.mu = 0.2, .c = 0.05});
  const fem::Stress<double> stress = stress_of(law, 1.0);
  for (const auto& row : stress.P)
    for (const double entry : row) EXPECT_NEAR(entry, 0.0, 1e-16);
}

TEST(HowToAddAMaterial, StressIsTheSlopeOfTheEnergy) {
  // Uniaxial and isochoric, J = 1: P_1 - P_2 F_2/F_1 = (mu + 2 c x) (L - L^-2), x = L^2 + 2/L - 3.
  const double L = 1.4;
  const double x = L * L + 2.0 / L - 3.0;
  const auto yeoh = stress_of(fem::Yeoh(fem::YeohEnergy{.mu = 0.2, .c = 0.05}), L);
  EXPECT_NEAR(yeoh.P[0][0] - yeoh.P[1][1] * std::pow(L, -1.5), (0.2 + 0.1 * x) * (L - 1.0 / (L * L)), 1e-15);
  // Without the second term it is the neo-Hookean law.
  const auto plain = stress_of(fem::Yeoh(fem::YeohEnergy{.mu = 0.2}), L);
  const auto neo_hookean = stress_of(fem::NeoHookean{.mu = 0.2}, L);
  EXPECT_NEAR(plain.P[0][0], neo_hookean.P[0][0], 1e-16);
}

/// Writes down what an objective asks of control::ObjectiveSum.
struct Asked {
  struct Coordinate {
    int rate = 0;
    double wanted = 0.0;
    double factor = 0.0;
  };
  int node = -1;
  Coordinate coordinate = {};

  int n_steps() const { return 20; }
  void add_squared_coordinate(int at, const Coordinate& term) {
    node = at;
    coordinate = term;
  }
};

TEST(HowToAddAnObjective, AsksForACoordinateInTheMiddle) {
  Asked sum;
  control::HalfWay{.rate = 3, .wanted = 0.1}.contribute(sum);
  EXPECT_EQ(sum.node, 10);
  EXPECT_EQ(sum.coordinate.rate, 3);
  EXPECT_EQ(sum.coordinate.wanted, 0.1);
  EXPECT_EQ(sum.coordinate.factor, 1.0);
}

}  // namespace
}  // namespace muldi
