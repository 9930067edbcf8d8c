/// Jets and duals against closed forms and each other.
#include "math/jet.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "math/jet_eigen.hpp"

namespace muldi::math {
namespace {

using Jet = Jet2<1>;

struct Function {
  std::string name;
  double x;
  std::function<Jet(const Jet&)> of_jet;
  std::function<double(double)> value, first, second;
};

std::vector<Function> functions() {
  using std::cosh;
  using std::pow;
  using std::sinh;
  return {
      {"sqrt", 1.7, [](const Jet& x) { return sqrt(x); }, [](double x) { return std::sqrt(x); },
       [](double x) { return 0.5 / std::sqrt(x); }, [](double x) { return -0.25 * pow(x, -1.5); }},
      {"exp", 0.4, [](const Jet& x) { return exp(x); }, [](double x) { return std::exp(x); },
       [](double x) { return std::exp(x); }, [](double x) { return std::exp(x); }},
      {"log", 1.3, [](const Jet& x) { return log(x); }, [](double x) { return std::log(x); },
       [](double x) { return 1.0 / x; }, [](double x) { return -1.0 / (x * x); }},
      {"sin", 0.7, [](const Jet& x) { return sin(x); }, [](double x) { return std::sin(x); },
       [](double x) { return std::cos(x); }, [](double x) { return -std::sin(x); }},
      {"cos", 0.7, [](const Jet& x) { return cos(x); }, [](double x) { return std::cos(x); },
       [](double x) { return -std::sin(x); }, [](double x) { return -std::cos(x); }},
      {"tan", 0.7, [](const Jet& x) { return tan(x); }, [](double x) { return std::tan(x); },
       [](double x) { return 1.0 / pow(std::cos(x), 2); },
       [](double x) { return 2.0 * std::sin(x) / pow(std::cos(x), 3); }},
      {"asin", 0.3, [](const Jet& x) { return asin(x); }, [](double x) { return std::asin(x); },
       [](double x) { return pow(1.0 - x * x, -0.5); }, [](double x) { return x * pow(1.0 - x * x, -1.5); }},
      {"acos", 0.3, [](const Jet& x) { return acos(x); }, [](double x) { return std::acos(x); },
       [](double x) { return -pow(1.0 - x * x, -0.5); }, [](double x) { return -x * pow(1.0 - x * x, -1.5); }},
      {"atan", 0.8, [](const Jet& x) { return atan(x); }, [](double x) { return std::atan(x); },
       [](double x) { return 1.0 / (1.0 + x * x); }, [](double x) { return -2.0 * x / pow(1.0 + x * x, 2); }},
      {"sinh", 0.8, [](const Jet& x) { return sinh(x); }, [](double x) { return std::sinh(x); },
       [](double x) { return std::cosh(x); }, [](double x) { return std::sinh(x); }},
      {"cosh", 0.8, [](const Jet& x) { return cosh(x); }, [](double x) { return std::cosh(x); },
       [](double x) { return std::sinh(x); }, [](double x) { return std::cosh(x); }},
      {"tanh", 0.8, [](const Jet& x) { return tanh(x); }, [](double x) { return std::tanh(x); },
       [](double x) { return pow(std::cosh(x), -2); },
       [](double x) { return -2.0 * std::sinh(x) * pow(std::cosh(x), -3); }},
      {"pow", 1.3, [](const Jet& x) { return pow(x, 2.7); }, [](double x) { return std::pow(x, 2.7); },
       [](double x) { return 2.7 * std::pow(x, 1.7); }, [](double x) { return 2.7 * 1.7 * std::pow(x, 0.7); }},
      {"abs", -1.3, [](const Jet& x) { return abs(x); }, [](double x) { return std::abs(x); },
       [](double) { return -1.0; }, [](double) { return 0.0; }},
      {"x^x", 1.3, [](const Jet& x) { return pow(x, x); }, [](double x) { return std::pow(x, x); },
       [](double x) { return std::pow(x, x) * (std::log(x) + 1.0); },
       [](double x) { return std::pow(x, x) * (pow(std::log(x) + 1.0, 2) + 1.0 / x); }},
      {"2 - 1/(x/3) + 1", 1.3, [](const Jet& x) { return 2 - 1 / (x / 3) + 1; }, [](double x) { return 3.0 - 3.0 / x; },
       [](double x) { return 3.0 / (x * x); }, [](double x) { return -6.0 / (x * x * x); }},
  };
}

TEST(Jet2, FunctionsHaveTheirClosedDerivatives) {
  for (const Function& f : functions()) {
    const Jet y = f.of_jet(Jet::variable(f.x, 0));
    EXPECT_NEAR(y.value, f.value(f.x), 1e-14) << f.name;
    EXPECT_NEAR(y.d(0), f.first(f.x), 1e-14) << f.name;
    EXPECT_NEAR(y.dd(0, 0), f.second(f.x), 1e-13) << f.name;
  }
}

/// exp(x y) sin(z)/y + z^3 and its derivatives by hand where they are used below.
template <class S>
S sample(const S& x, const S& y, const S& z) {
  using std::exp;
  using std::sin;
  return exp(x * y) * sin(z) / y + z * z * z;
}

TEST(Jet2, HasGradientAndSymmetricHessianOfSeveralVariables) {
  using J = Jet2<3>;
  const double x = 0.4;
  const double y = 1.2;
  const double z = 0.7;
  const J f = sample(J::variable(x, 0), J::variable(y, 1), J::variable(z, 2));
  const double e = std::exp(x * y);
  EXPECT_NEAR(f.d(0), e * std::sin(z), 1e-14);
  EXPECT_NEAR(f.d(1), e * std::sin(z) * (x / y - 1.0 / (y * y)), 1e-14);
  EXPECT_NEAR(f.d(2), e * std::cos(z) / y + 3.0 * z * z, 1e-14);
  EXPECT_NEAR(f.dd(0, 1), x * e * std::sin(z), 1e-14);
  EXPECT_NEAR(f.dd(0, 2), e * std::cos(z), 1e-14);
  EXPECT_NEAR(f.dd(2, 2), -e * std::sin(z) / y + 6.0 * z, 1e-14);
  EXPECT_EQ(f.dd(2, 0), f.dd(0, 2));
}

TEST(Jet2, NestsWithDualEitherWayToTheSameThirdDerivatives) {
  const std::array<double, 3> at{0.4, 1.2, 0.7};
  const std::array<double, 3> direction{0.3, -0.8, 0.5};
  using Inside = Jet2<3, Dual<>>;
  using Outside = Dual<Jet2<3>>;
  std::array<Inside, 3> inside;
  std::array<Outside, 3> outside;
  for (std::size_t i = 0; i < 3; ++i) {
    inside[i] = Inside::variable(Dual<>(at[i], direction[i]), static_cast<int>(i));
    outside[i] = Outside(Jet2<3>::variable(at[i], static_cast<int>(i)), Jet2<3>(direction[i]));
  }
  const Inside a = sample(inside[0], inside[1], inside[2]);
  const Outside b = sample(outside[0], outside[1], outside[2]);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(a.dd(i, j).slope, b.slope.dd(i, j), 1e-13);
  }
  // d3f/dx2dy = e^(xy) sin z (1 + x y) and so on: the slope of f_xx = y e^(xy) sin z.
  const double e = std::exp(0.48);
  const double expected = direction[0] * 1.44 * e * std::sin(0.7) + direction[1] * (1.0 + 0.48) * e * std::sin(0.7) +
                          direction[2] * 1.2 * e * std::cos(0.7);
  EXPECT_NEAR(a.dd(0, 0).slope, expected, 1e-14);
}

TEST(Jet2, AngleOfAPointIsRightInEveryQuadrant) {
  for (const double angle : {0.1, 1.5, 1.7, 3.0, -0.2, -1.6, -3.1}) {
    using J = Jet2<2>;
    const double r = 1.7;
    const J theta = atan2(J::variable(r * std::sin(angle), 0), J::variable(r * std::cos(angle), 1));
    EXPECT_NEAR(theta.value, angle, 1e-15);
    EXPECT_NEAR(theta.d(0), std::cos(angle) / r, 1e-14);
    EXPECT_NEAR(theta.d(1), -std::sin(angle) / r, 1e-14);
    EXPECT_NEAR(theta.dd(0, 1), -std::cos(2.0 * angle) / (r * r), 1e-14);
  }
}

TEST(Jet2, PowersOfZeroHaveFiniteDerivatives) {
  const Jet square = pow(Jet::variable(0.0, 0), 2.0);
  EXPECT_EQ(square.d(0), 0.0);
  EXPECT_EQ(square.dd(0, 0), 2.0);
  EXPECT_EQ(pow(Jet::variable(0.0, 0), 1.0).d(0), 1.0);
  EXPECT_EQ(pow(Jet::variable(0.0, 0), 0.0).d(0), 0.0);
}

TEST(Jet2, ComparesByValue) {
  const Jet x = Jet::variable(2.0, 0);
  EXPECT_TRUE(x > 1.0);
  EXPECT_TRUE(x < Jet(3.0));
  EXPECT_TRUE(1.0 < x);
  EXPECT_TRUE(x == 2.0);
  EXPECT_EQ(number(Dual<Jet>(x)), 2.0);
}

TEST(Jet2, LivesInSmallVectorsOfEigen) {
  using J = Jet2<3>;
  Eigen::Matrix<J, 3, 1> a;
  for (int i = 0; i < 3; ++i) a(i) = J::variable(1.0 + i, i);
  const Eigen::Matrix<J, 3, 1> twice = 2.0 * a;
  const J f = a.cross(twice + Eigen::Matrix<J, 3, 1>::UnitX()).dot(a) + a.squaredNorm();
  EXPECT_DOUBLE_EQ(f.value, 14.0);
  EXPECT_DOUBLE_EQ(f.d(2), 6.0);
  EXPECT_DOUBLE_EQ(f.dd(1, 1), 2.0);
  EXPECT_NEAR(sqrt(a.squaredNorm()).d(1), 2.0 / std::sqrt(14.0), 1e-15);
}

}  // namespace
}  // namespace muldi::math
