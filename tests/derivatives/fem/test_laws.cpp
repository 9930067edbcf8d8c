/// Every material law against derivatives of its energy by jets, and what physics asks of it.
#include <cmath>

#include "derivatives/fem/laws.hpp"
#include "fem/materials/from_energy.hpp"
#include "math/derivative_check.hpp"

namespace muldi {
namespace {

using fem::Point;
using fem::Stress;
using fem::Tangent;
using Dual = math::Dual<>;

template <class Law>
class LawTest : public testing::Test {};
TYPED_TEST_SUITE(LawTest, test::TypesOf<fem::EnergyLaws>::type);

Eigen::VectorXd vector_of(const std::vector<double>& list) {
  return Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
}

template <class Law>
Eigen::MatrixXd tangent_of(const Law& law, const Point<double>& at) {
  Tangent<double> tangent{};
  law.add_tangent(at, tangent);
  return test::whole(tangent);
}

/// Derivatives of the hand-written stress by duals, one column a variable.
template <class Law>
Eigen::MatrixXd derivative_of_stress(const Law& law, const Point<double>& at) {
  Eigen::MatrixXd A(12, 12);
  for (int variable = 0; variable < 12; ++variable) {
    Point<Dual> seeded;
    for (int n = 0; n < 9; ++n) seeded.F[n / 3][n % 3] = Dual(at.F[n / 3][n % 3], n == variable ? 1.0 : 0.0);
    for (int m = 0; m < 3; ++m) seeded.E[m] = Dual(at.E[m], 9 + m == variable ? 1.0 : 0.0);
    seeded.complete();
    const std::vector<Dual> column = test::gradient(law, seeded);
    for (int row = 0; row < 12; ++row) A(row, variable) = column[static_cast<std::size_t>(row)].slope;
  }
  return A;
}

TYPED_TEST(LawTest, StressIsTheDerivativeOfTheEnergy) {
  std::mt19937 random(1);
  const Eigen::MatrixXd size = test::sizes().asDiagonal();
  for (const TypeParam& law : test::examples<TypeParam>()) {
    for (int k = 0; k < 50; ++k) {
      const Point<double> at = test::random_point(random);
      const Eigen::VectorXd hand = vector_of(test::gradient(law, at)).cwiseProduct(test::sizes());
      const Eigen::VectorXd jets =
          vector_of(test::gradient(fem::FromEnergy<TypeParam>(law), at)).cwiseProduct(test::sizes());
      // Where the stress nearly vanishes, the round-off of F times the stiffness is left.
      const double stiffness = (size * tangent_of(law, at) * size).cwiseAbs().maxCoeff();
      EXPECT_LE((hand - jets).cwiseAbs().maxCoeff(), 1e-13 * jets.cwiseAbs().maxCoeff() + 1e-15 * stiffness);
    }
  }
}

TYPED_TEST(LawTest, TangentIsTheSecondDerivativeOfTheEnergy) {
  std::mt19937 random(2);
  const Eigen::MatrixXd size = test::sizes().asDiagonal();
  for (const TypeParam& law : test::examples<TypeParam>()) {
    for (int k = 0; k < 50; ++k) {
      const Point<double> at = test::random_point(random);
      const Eigen::MatrixXd hand = size * tangent_of(law, at) * size;
      const Eigen::MatrixXd jets = size * tangent_of(fem::FromEnergy<TypeParam>(law), at) * size;
      EXPECT_LE(math::derivative_error(hand, jets).relative, 1e-12);
    }
  }
}

TYPED_TEST(LawTest, TangentIsSymmetricAndTheDerivativeOfTheStress) {
  std::mt19937 random(3);
  const Eigen::MatrixXd size = test::sizes().asDiagonal();
  for (const TypeParam& law : test::examples<TypeParam>()) {
    const Point<double> at = test::random_point(random);
    const Eigen::MatrixXd hand = size * tangent_of(law, at) * size;
    const Eigen::MatrixXd duals = size * derivative_of_stress(law, at) * size;
    EXPECT_LE(math::derivative_error(hand, duals).relative, 1e-12);
    EXPECT_LE(math::derivative_error(duals.transpose(), duals).relative, 1e-12);
  }
}

TYPED_TEST(LawTest, DoesNotNoticeRotations) {
  std::mt19937 random(4);
  for (const TypeParam& law : test::examples<TypeParam>()) {
    const Point<double> at = test::random_point(random);
    const Eigen::Matrix3d Q = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
    const auto matrix = [](const double(&m)[3][3]) {
      return Eigen::Matrix3d(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&m[0][0]));
    };
    Point<double> turned = at;
    const Eigen::Matrix3d QF = Q * matrix(at.F);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) turned.F[i][k] = QF(i, k);
    turned.complete();
    Stress<double> here{};
    Stress<double> there{};
    law.add_stress(at, here);
    law.add_stress(turned, there);
    EXPECT_NEAR(law.energy(turned), law.energy(at), 1e-13 * std::abs(law.energy(at)));
    EXPECT_LE((matrix(there.P) - Q * matrix(here.P)).norm(), 1e-13 * matrix(here.P).norm());
    for (int m = 0; m < 3; ++m) EXPECT_NEAR(there.D[m], here.D[m], 1e-18);
  }
}

TYPED_TEST(LawTest, IsAtRestWithoutDeformationAndField) {
  for (const TypeParam& law : test::examples<TypeParam>()) {
    EXPECT_NEAR(law.energy(test::rest()), 0.0, 1e-15);
    for (const double entry : test::gradient(law, test::rest())) EXPECT_NEAR(entry, 0.0, 1e-15);
  }
}

TYPED_TEST(LawTest, IsFiniteWhereTheElementIsInverted) {
  std::mt19937 random(5);
  for (const TypeParam& law : test::examples<TypeParam>()) {
    Point<double> at = test::random_point(random);
    for (double& entry : at.F[0]) entry = -entry;
    at.complete();
    ASSERT_LT(at.det, 0.0);
    EXPECT_TRUE(std::isfinite(law.energy(at)));
    EXPECT_TRUE(vector_of(test::gradient(law, at)).allFinite());
    EXPECT_TRUE(tangent_of(law, at).allFinite());
  }
}

/// Lane by lane the values of the plain number, by hand-written derivatives and by jets over lanes.
template <class Law, class L>
void expect_lanes_equal_numbers(const Law& law) {
  std::mt19937 random(6);
  Point<L> lanes{};
  std::vector<Point<double>> numbers;
  for (int lane = 0; lane < L::size; ++lane) {
    numbers.push_back(test::random_point(random));
    for (int i = 0; i < 3; ++i) {
      lanes.E[i].set(lane, numbers.back().E[i]);
      for (int k = 0; k < 3; ++k) lanes.F[i][k].set(lane, numbers.back().F[i][k]);
    }
  }
  lanes.complete();
  Stress<L> stress{};
  Stress<L> by_jets{};
  Tangent<L> tangent{};
  Tangent<L> tangent_by_jets{};
  law.add_stress(lanes, stress);
  law.add_tangent(lanes, tangent);
  fem::FromEnergy<Law>(law).add_stress(lanes, by_jets);
  fem::FromEnergy<Law>(law).add_tangent(lanes, tangent_by_jets);
  const Eigen::MatrixXd size = test::sizes().asDiagonal();
  for (int lane = 0; lane < L::size; ++lane) {
    const auto number = [lane](const std::vector<L>& list) {
      Eigen::VectorXd v(12);
      for (int n = 0; n < 12; ++n) v[n] = list[static_cast<std::size_t>(n)][lane];
      return Eigen::VectorXd(v.cwiseProduct(test::sizes()));
    };
    const auto matrix = [&](const Tangent<L>& of) {
      Tangent<double> plain;
      for (int pair = 0; pair < 10; ++pair)
        for (int kl = 0; kl < 9; ++kl) plain.block[pair][kl] = of.block[pair][kl][lane];
      return Eigen::MatrixXd(size * test::whole(plain) * size);
    };
    const Point<double>& at = numbers[static_cast<std::size_t>(lane)];
    const Eigen::VectorXd expected = vector_of(test::gradient(law, at)).cwiseProduct(test::sizes());
    const Eigen::MatrixXd expected_tangent = size * tangent_of(law, at) * size;
    EXPECT_LE(math::derivative_error(number(test::gradient_of(stress)), expected).relative, 1e-13);
    EXPECT_LE(math::derivative_error(number(test::gradient_of(by_jets)), expected).relative, 1e-13);
    EXPECT_LE(math::derivative_error(matrix(tangent), expected_tangent).relative, 1e-13);
    EXPECT_LE(math::derivative_error(matrix(tangent_by_jets), expected_tangent).relative, 1e-12);
  }
}

TYPED_TEST(LawTest, HasTheSameValuesInLanes) {
  for (const TypeParam& law : test::examples<TypeParam>()) {
    expect_lanes_equal_numbers<TypeParam, fem::Lanes<2, 0>>(law);
    expect_lanes_equal_numbers<TypeParam, fem::Lanes<4, 0>>(law);
  }
}

TEST(Gent, ReportsTheUsedUpStretchAsMargin) {
  const fem::Gent law{.mu = 0.233, .J_m = 1.0};
  Point<double> at = test::rest();
  at.F[0][0] = 2.0;
  at.F[1][1] = at.F[2][2] = std::sqrt(0.5);
  at.complete();
  Stress<double> stress{};
  stress.limit = at.det;
  law.add_stress(at, stress);
  // Trace 4 + 1/2 + 1/2 = 5 at J = 1: 1 - (5 - 3)/1.
  EXPECT_NEAR(stress.limit, -1.0, 1e-14);
}

fem::Point<Dual> rate_seeded(const Point<double>& at, int variable) {
  Point<Dual> seeded;
  for (int n = 0; n < 9; ++n) {
    seeded.F[n / 3][n % 3] = at.F[n / 3][n % 3];
    seeded.F_rate[n / 3][n % 3] = Dual(at.F_rate[n / 3][n % 3], n == variable ? 1.0 : 0.0);
  }
  seeded.complete();
  return seeded;
}

TEST(KelvinVoigt, RateTangentIsTheDerivativeByTheRate) {
  std::mt19937 random(7);
  const fem::KelvinVoigt law{.viscosity = 0.4};
  const Point<double> at = test::random_point(random);
  Tangent<double> tangent{};
  law.add_rate_tangent(at, 0.7, tangent);
  Eigen::MatrixXd duals(9, 9);
  for (int variable = 0; variable < 9; ++variable) {
    const std::vector<Dual> column = test::gradient(law, rate_seeded(at, variable));
    for (int row = 0; row < 9; ++row) duals(row, variable) = 0.7 * column[static_cast<std::size_t>(row)].slope;
  }
  EXPECT_LE(math::derivative_error(test::whole(tangent).topLeftCorner(9, 9), duals).relative, 1e-13);
}

TEST(KelvinVoigt, StressIsThatOfNumerics) {
  // numerics 1.3: P = 1/2 eta J (F^-T Fdot^T F^-T + Fdot C^-1).
  std::mt19937 random(8);
  const Point<double> at = test::random_point(random);
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Matrix3d F = Eigen::Map<const RowMajor>(&at.F[0][0]);
  const Eigen::Matrix3d rate = Eigen::Map<const RowMajor>(&at.F_rate[0][0]);
  const Eigen::Matrix3d f = F.inverse();
  const Eigen::Matrix3d expected =
      0.5 * 0.4 * F.determinant() * (f.transpose() * rate.transpose() * f.transpose() + rate * f * f.transpose());
  Stress<double> stress{};
  const fem::KelvinVoigt law{.viscosity = 0.4};
  law.add_stress(at, stress);
  const Eigen::Matrix3d P = Eigen::Map<const RowMajor>(&stress.P[0][0]);
  EXPECT_LE((P - expected).norm(), 1e-14 * expected.norm());
  EXPECT_NEAR(law.dissipation(at), P.cwiseProduct(rate).sum(), 1e-13 * law.dissipation(at));
}

TEST(KelvinVoigt, MidpointRotationDissipatesNothing) {
  std::mt19937 random(9);
  const Point<double> start = test::random_point(random);
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Matrix3d U = Eigen::Map<const RowMajor>(&start.F[0][0]);
  const Eigen::Matrix3d F1 = Eigen::AngleAxisd(0.8, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()) * U;
  Point<double> at;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      at.F[i][k] = 0.5 * (U(i, k) + F1(i, k));
      at.F_rate[i][k] = F1(i, k) - U(i, k);
    }
  }
  at.complete();
  Stress<double> stress{};
  const fem::KelvinVoigt law{.viscosity = 1.0};
  law.add_stress(at, stress);
  // The rate over the midpoint is skew (numerics 1.3): only round-off is left.
  EXPECT_LE(law.dissipation(at), 1e-28);
  for (const auto& row : stress.P)
    for (const double entry : row) EXPECT_NEAR(entry, 0.0, 1e-14);
}

}  // namespace
}  // namespace muldi
