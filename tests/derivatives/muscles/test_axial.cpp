/// Hand-written scalar derivatives of the two-point elements against jets and the complex step.
#include <complex>

#include "derivatives/muscles/battery.hpp"
#include "math/derivative_check.hpp"

namespace muldi {
namespace {

using math::Dual;
using muscles::AxialDerivatives;
using muscles::Controls;

template <class S, int n>
std::vector<S> as_list(const AxialDerivatives<S, n>& d) {
  std::vector<S> list{d.l_z, d.l_d, d.l_zz, d.l_zd, d.l_dd, d.f, d.f_z, d.f_d};
  list.insert(list.end(), d.h_e.begin(), d.h_e.end());
  return list;
}

/// Relative to the entry: no seed is near an equilibrium, where the parts of l_z cancel.
void expect_close(double given, double expected, std::size_t entry) {
  EXPECT_LE(std::abs(given - expected), 1e-11 * std::max(std::abs(given), std::abs(expected))) << "entry " << entry;
}

template <class Element>
class AxialElementTest : public testing::Test {};
TYPED_TEST_SUITE(AxialElementTest, test::TypesOf<test::AxialTypes>::type);

TYPED_TEST(AxialElementTest, HandDerivativesAreThoseOfTheEnergies) {
  std::mt19937 random(1);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    for (int k = 0; k < 20; ++k) {
      const auto x = test::random_state<TypeParam::n_controls>(random);
      const auto hand = as_list(muscles::axial_derivatives(element, x.length(), x.rate(), x.e));
      const auto jets = as_list(muscles::axial_by_jets(element, x.length(), x.rate(), x.e));
      for (std::size_t i = 0; i < hand.size(); ++i) expect_close(hand[i], jets[i], i);
    }
  }
}

TYPED_TEST(AxialElementTest, HandDerivativesGiveThirdDerivativesWithADual) {
  std::mt19937 random(2);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    const auto x = test::random_state<TypeParam::n_controls>(random);
    const Dual<> z(x.length(), 0.3);
    const Dual<> zd(x.rate(), -0.7);
    Controls<Dual<>, TypeParam::n_controls> e;
    for (std::size_t c = 0; c < e.size(); ++c) e[c] = Dual<>(x.e[c], 500.0);
    const auto hand = as_list(muscles::axial_derivatives(element, z, zd, e));
    const auto jets = as_list(muscles::axial_by_jets(element, z, zd, e));
    for (std::size_t i = 0; i < hand.size(); ++i) {
      expect_close(hand[i].value, jets[i].value, i);
      expect_close(hand[i].slope, jets[i].slope, i);
    }
  }
}

TYPED_TEST(AxialElementTest, FirstDerivativesAreThoseOfTheComplexStep) {
  using Complex = std::complex<double>;
  std::mt19937 random(3);
  constexpr int n = TypeParam::n_controls;
  for (const TypeParam& element : test::examples<TypeParam>()) {
    const auto x = test::random_state<n>(random);
    const auto lagrangian_and_force = [&](const Eigen::VectorXcd& at) {
      Controls<Complex, n> e;
      for (std::size_t c = 0; c < e.size(); ++c) e[c] = x.e[c];
      const Complex l = muscles::kinetic_energy(element, at[0], at[1]) - element.elastic(at[0]) -
                        muscles::electric_energy(element, at[0], e);
      return Eigen::VectorXcd{{l, element.force(at[0], at[1], e)}};
    };
    const auto reference = math::complex_step_jacobian(lagrangian_and_force, Eigen::Vector2d(x.length(), x.rate()));
    const auto hand = muscles::axial_derivatives(element, x.length(), x.rate(), x.e);
    EXPECT_LE(math::derivative_error(Eigen::RowVector2d(hand.l_z, hand.l_d), reference.row(0)).relative, 1e-11);
    EXPECT_LE(math::derivative_error(Eigen::RowVector2d(hand.f_z, hand.f_d), reference.row(1)).relative, 1e-11);
  }
}

}  // namespace
}  // namespace muldi
