/// Material laws at single points against the numbers of numerics 3.4 and 3.5.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fem/kernel/lanes.hpp"
#include "fem/material.hpp"

namespace muldi::fem {
namespace {

constexpr double mu = 0.233;
constexpr double eps0 = 8.8542e-12;

Point<double> deformed(std::array<double, 9> F, std::array<double, 3> E = {}) {
  Point<double> at;
  for (int i = 0; i < 3; ++i) {
    at.E[i] = E[static_cast<std::size_t>(i)];
    for (int k = 0; k < 3; ++k) at.F[i][k] = F[static_cast<std::size_t>(3 * i + k)];
  }
  at.complete();
  return at;
}

struct Answer {
  double energy = 0.0;
  Stress<double> stress{};
};

template <class... Laws>
Answer sum(const Point<double>& at, const Laws&... laws) {
  Answer answer;
  ((answer.energy += laws.energy(at), laws.add_stress(at, answer.stress)), ...);
  return answer;
}

void expect_matrix(const double (&given)[3][3], const std::array<double, 9>& expected, double digits) {
  for (int n = 0; n < 9; ++n) {
    const double want = expected[static_cast<std::size_t>(n)];
    EXPECT_NEAR(given[n / 3][n % 3], want, digits * std::max(std::abs(want), 1e-3)) << n / 3 << n % 3;
  }
}

// The printed numbers have twelve digits.
constexpr double printed = 5e-12;

TEST(BonetWood, StressesAndEnergiesArePublished) {
  const BonetWood law{.mu = mu, .lambda = 10.0};
  const Answer triaxial = sum(deformed({1.2, 0, 0, 0, 0.9, 0, 0, 0, 0.95}), law);
  expect_matrix(triaxial.stress.P, {0.299331222905, 0, 0, 0, 0.236008297206, 0, 0, 0, 0.246273649985}, printed);
  EXPECT_NEAR(triaxial.energy, 0.0150798311233, printed * 0.0150798311233);
  const Answer shear = sum(deformed({1, 0.4, 0, 0, 1, 0, 0, 0, 1}), law);
  EXPECT_NEAR(shear.stress.P[0][1], 0.0932, 1e-16);
  EXPECT_NEAR(shear.energy, 0.01864, 1e-16);
}

TEST(NeoHookean, WithAVolumetricEnergyStressesAndEnergiesArePublished) {
  const Answer answer =
      sum(deformed({1.2, 0, 0, 0, 0.9, 0, 0, 0, 0.95}), NeoHookean{.mu = mu}, Quadratic{.kappa = 1000.0});
  expect_matrix(answer.stress.P, {22.30428117, 0, 0, 0, 29.5787087562, 0, 0, 0, 28.0442365425}, printed);
  EXPECT_NEAR(answer.energy, 0.349535117031, printed * 0.349535117031);
}

TEST(NeoHookean, UniaxialIncompressibleStressIsPublished) {
  // P = mu (L - L^-2) once the pressure that frees the sides is added: P_11 - P_22 F_22/F_11.
  const std::array<std::array<double, 2>, 4> table{
      {{0.7, -0.312410204082}, {0.9, -0.0779543209877}, {1.1, 0.0637380165289}, {1.5, 0.245944444444}}};
  for (const auto& [stretch, expected] : table) {
    const double side = 1.0 / std::sqrt(stretch);
    const Answer answer = sum(deformed({stretch, 0, 0, 0, side, 0, 0, 0, side}), NeoHookean{.mu = mu});
    EXPECT_NEAR(answer.stress.P[0][0] - answer.stress.P[1][1] * side / stretch, expected, 2e-11 * std::abs(expected));
  }
}

/// The manufactured solution of numerics 3.5 at X = (.3, .5, .7): F = 1 + 2 a (0 Y 0; 0 0 Z; X 0 0).
Point<double> manufactured() { return deformed({1, 0.1, 0, 0, 1, 0.14, 0.06, 0, 1}, {8500, 1500, 20000}); }

TEST(IdealDielectric, CoupledStressAndDisplacementArePublished) {
  const Answer answer =
      sum(manufactured(), BonetWood{.mu = mu, .lambda = 10.0}, IdealDielectric{.permittivity = 3.7 * eps0});
  expect_matrix(answer.stress.P,
                {0.00301625758903, 0.0208852778283, 0.0185645156383, 0.0233673243892, 0.00116985628468, 0.0317197558136,
                 0.0156279098938, 0.0311758119983, 0.0138998805614},
                printed);
  const double D[3] = {2.45966765413e-07, -6.40204060909e-08, 6.37471584935e-07};
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(answer.stress.D[k], D[k], printed * std::abs(D[k]));
  EXPECT_NEAR(answer.energy, -0.00369637210263, printed * 0.00369637210263);
}

TEST(Vu, CoupledStressAndDisplacementArePublished) {
  const Answer answer =
      sum(manufactured(), BonetWood{.mu = mu, .lambda = 10.0}, Vu{.c1 = 5e-8, .c2 = 1e-9, .eps0 = eps0});
  expect_matrix(answer.stress.P,
                {0.154129921778, 0.047221768982, 0.360843175259, 0.0957917240784, 0.0194808943987, 0.2033941169,
                 0.360802708712, 0.092882618535, 0.830421441501},
                printed);
  const double D[3] = {-0.000869694722496, -0.000160347302812, -0.00204205171038};
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(answer.stress.D[k], D[k], printed * std::abs(D[k]));
  EXPECT_NEAR(answer.energy, 24.2406558387, printed * 24.2406558387);
}

TEST(Invariants, WithC2AloneIsAnIdealDielectricAtConstantVolume) {
  // c2 I4 - eps0/2 J I4 against -eps/2 J I4 with eps = eps0 - 2 c2: one energy where J = 1.
  const double stretch = 0.8;
  const double side = 1.0 / std::sqrt(stretch);
  const Point<double> at = deformed({stretch, 0, 0, 0, side, 0, 0, 0, side}, {2e4, 0, 1e3});
  const Answer law = sum(at, Invariants{.c1 = 0.0, .c2 = -1.35 * eps0, .c3 = 0.0, .eps0 = eps0});
  const Answer ideal = sum(at, IdealDielectric{.permittivity = 3.7 * eps0});
  EXPECT_NEAR(law.energy, ideal.energy, 1e-14 * std::abs(ideal.energy));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(law.stress.D[k], ideal.stress.D[k], 1e-14 * std::abs(ideal.stress.D[0]));
}

TEST(ElectricCurvature, IsNegativeForAPhysicalDielectricOnly) {
  const std::array<double, 9> one{1, 0, 0, 0, 1, 0, 0, 0, 1};
  const auto curvature = [&](const base::VariantOf<ElectricLaws>& law) {
    return largest_electric_curvature({.electric = law}, one, {});
  };
  EXPECT_NEAR(curvature(IdealDielectric{.permittivity = 3.7 * eps0}), -3.7 * eps0, 1e-26);
  // The published parameters of the thesis have the unphysical sign (numerics C1): 2 (c1 + c2) - eps0.
  EXPECT_NEAR(curvature(Vu{.c1 = 5e-8, .c2 = 1e-9, .eps0 = eps0}), 1.02e-7 - eps0, 1e-21);
  EXPECT_EQ(largest_electric_curvature({}, one, {}), -INFINITY);
}

template <class L>
void expect_elementary_functions() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-40.0, 40.0);
  double worst_log = 0.0;
  double worst_root = 0.0;
  for (int n = 0; n < 20000; ++n) {
    L x;
    for (int lane = 0; lane < L::size; ++lane) {
      x.set(lane, n % 2 == 0 ? std::exp2(exponent(random)) : 1.0 + 0.01 * exponent(random));
    }
    const L logarithm = log(x);
    const L root = inverse_cbrt(x);
    for (int lane = 0; lane < L::size; ++lane) {
      worst_log = std::max(worst_log, std::abs(logarithm[lane] / std::log(x[lane]) - 1.0));
      worst_root = std::max(worst_root, std::abs(root[lane] * std::cbrt(x[lane]) - 1.0));
    }
  }
  // Units in the last place are at most 2.2e-16: about one of ours, one of the referee's.
  EXPECT_LE(worst_log, 4.5e-16);
  EXPECT_LE(worst_root, 7e-16);
  EXPECT_EQ(log(L(1.0))[0], 0.0);
}

TEST(Lanes, LogarithmAndCubeRootAreThoseOfTheStandardLibrary) {
  expect_elementary_functions<Lanes<2, 0>>();
  expect_elementary_functions<Lanes<4, 0>>();
}

TEST(Lanes, TransposeExchangesLanesAndValues) {
  using L = Lanes<4, 0>;
  L x[4];
  for (int i = 0; i < 4; ++i)
    for (int lane = 0; lane < 4; ++lane) x[i].set(lane, 10.0 * i + lane);
  transpose(x);
  for (int i = 0; i < 4; ++i)
    for (int lane = 0; lane < 4; ++lane) EXPECT_EQ(x[i][lane], 10.0 * lane + i);
}

}  // namespace
}  // namespace muldi::fem
