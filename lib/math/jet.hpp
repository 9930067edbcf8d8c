#pragma once
/// Forward automatic differentiation: `Dual` carries one directional derivative, `Jet2` gradient and Hessian.
///
/// Both are templates of the inner scalar, so they nest: Jet2<N, Dual<>> and Dual<Jet2<N>> give the third derivatives
/// along one direction. The functions live in math/jet_functions.hpp, which this header includes.
#include <array>
#include <compare>
#include <complex>
#include <concepts>
#include <cstddef>
#include <type_traits>

namespace muldi::math {

/// x + d eps with eps^2 = 0.
template <class S = double>
struct Dual {
  using Scalar = S;

  S value{};
  S slope{};  ///< derivative along the seeded direction

  Dual() = default;
  Dual(const S& v) : value(v) {}  // NOLINT(google-explicit-constructor): numbers are constants
  Dual(const S& v, const S& d) : value(v), slope(d) {}
  template <class A>
  requires(std::is_arithmetic_v<A> && !std::same_as<A, S>) Dual(A v)
      : value(static_cast<double>(v)) {}  // NOLINT(google-explicit-constructor)

  Dual& operator+=(const Dual& b) {
    value += b.value;
    slope += b.slope;
    return *this;
  }
  Dual& operator-=(const Dual& b) {
    value -= b.value;
    slope -= b.slope;
    return *this;
  }
  Dual& operator*=(const Dual& b) {
    slope = slope * b.value + value * b.slope;
    value *= b.value;
    return *this;
  }
  Dual& operator*=(const S& b) {
    value *= b;
    slope *= b;
    return *this;
  }
  Dual operator-() const { return {-value, -slope}; }

  /// phi(x) from phi, phi', phi'' at x.value.
  friend Dual chain(const Dual& x, const S& phi, const S& phi_1, const S&) { return {phi, phi_1 * x.slope}; }
};

/// Value, gradient and Hessian of a function of N variables.
template <int N, class S = double>
struct Jet2 {
  using Scalar = S;
  static constexpr std::size_t n = static_cast<std::size_t>(N);
  static constexpr std::size_t n_packed = n * (n + 1) / 2;

  S value{};
  std::array<S, n> gradient{};
  std::array<S, n_packed> hessian{};  ///< lower triangle, by rows

  Jet2() = default;
  Jet2(const S& v) : value(v) {}  // NOLINT(google-explicit-constructor): numbers are constants
  template <class A>
  requires(std::is_arithmetic_v<A> && !std::same_as<A, S>) Jet2(A v)
      : value(static_cast<double>(v)) {}  // NOLINT(google-explicit-constructor)

  /// The variable `index` in 0 .. N-1 at value v.
  static Jet2 variable(const S& v, int index) {
    Jet2 x(v);
    x.gradient[static_cast<std::size_t>(index)] = S(1.0);
    return x;
  }

  /// First derivative by variable i.
  const S& d(int i) const { return gradient[static_cast<std::size_t>(i)]; }
  /// Second derivative by variables i and j.
  const S& dd(int i, int j) const {
    const auto row = static_cast<std::size_t>(i > j ? i : j);
    const auto column = static_cast<std::size_t>(i > j ? j : i);
    return hessian[row * (row + 1) / 2 + column];
  }

  Jet2& operator+=(const Jet2& b) {
    value += b.value;
    for (std::size_t i = 0; i < n; ++i) gradient[i] += b.gradient[i];
    for (std::size_t k = 0; k < n_packed; ++k) hessian[k] += b.hessian[k];
    return *this;
  }
  Jet2& operator-=(const Jet2& b) {
    value -= b.value;
    for (std::size_t i = 0; i < n; ++i) gradient[i] -= b.gradient[i];
    for (std::size_t k = 0; k < n_packed; ++k) hessian[k] -= b.hessian[k];
    return *this;
  }
  Jet2& operator*=(const Jet2& b) {
    Jet2 product;
    product.value = value * b.value;
    std::size_t k = 0;
    for (std::size_t i = 0; i < n; ++i) {
      product.gradient[i] = gradient[i] * b.value + value * b.gradient[i];
      for (std::size_t j = 0; j <= i; ++j, ++k) {
        product.hessian[k] =
            hessian[k] * b.value + value * b.hessian[k] + gradient[i] * b.gradient[j] + gradient[j] * b.gradient[i];
      }
    }
    return *this = product;
  }
  Jet2& operator*=(const S& b) {
    value *= b;
    for (S& g : gradient) g *= b;
    for (S& h : hessian) h *= b;
    return *this;
  }
  Jet2 operator-() const {
    Jet2 result;
    result -= *this;
    return result;
  }

  /// phi(x) from phi, phi', phi'' at x.value.
  friend Jet2 chain(const Jet2& x, const S& phi, const S& phi_1, const S& phi_2) {
    Jet2 result;
    result.value = phi;
    std::size_t k = 0;
    for (std::size_t i = 0; i < n; ++i) {
      result.gradient[i] = phi_1 * x.gradient[i];
      const S scaled = phi_2 * x.gradient[i];
      for (std::size_t j = 0; j <= i; ++j, ++k) result.hessian[k] = phi_1 * x.hessian[k] + scaled * x.gradient[j];
    }
    return result;
  }
};

template <class T>
inline constexpr bool is_jet = false;
template <class S>
inline constexpr bool is_jet<Dual<S>> = true;
template <int N, class S>
inline constexpr bool is_jet<Jet2<N, S>> = true;

/// Dual or Jet2, of any inner scalar.
template <class T>
concept Jet = is_jet<T>;

/// The number at the bottom of a scalar; branches ask it. That of a complex step is the real part.
constexpr double number(double x) { return x; }
inline double number(const std::complex<double>& x) { return x.real(); }
template <Jet J>
double number(const J& x) {
  return number(x.value);
}

}  // namespace muldi::math

#include "math/jet_functions.hpp"
