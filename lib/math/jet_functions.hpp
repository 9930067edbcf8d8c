#pragma once
/// Arithmetic, comparison and elementary functions of jets; include math/jet.hpp.
#include <cmath>
#include <compare>

#include "math/jet.hpp"

namespace muldi::math {

template <Jet J>
J operator+(J a, const J& b) {
  return a += b;
}
template <Jet J>
J operator+(J a, const typename J::Scalar& b) {
  a.value += b;
  return a;
}
template <Jet J>
J operator+(const typename J::Scalar& a, J b) {
  b.value += a;
  return b;
}
template <Jet J>
J operator-(J a, const J& b) {
  return a -= b;
}
template <Jet J>
J operator-(J a, const typename J::Scalar& b) {
  a.value -= b;
  return a;
}
template <Jet J>
J operator-(const typename J::Scalar& a, const J& b) {
  return -b + a;
}
template <Jet J>
J operator*(J a, const J& b) {
  return a *= b;
}
template <Jet J>
J operator*(J a, const typename J::Scalar& b) {
  return a *= b;
}
template <Jet J>
J operator*(const typename J::Scalar& a, J b) {
  return b *= a;
}

/// 1/x.
template <Jet J>
J inverse(const J& x) {
  using S = typename J::Scalar;
  const S i = 1.0 / x.value;
  return chain(x, i, S(-i * i), S(2.0 * i * i * i));
}
template <Jet J>
J operator/(const J& a, const J& b) {
  return a * inverse(b);
}
template <Jet J>
J operator/(J a, const typename J::Scalar& b) {
  return a *= typename J::Scalar(1.0 / b);
}
template <Jet J>
J operator/(const typename J::Scalar& a, const J& b) {
  return a * inverse(b);
}
template <Jet J>
J& operator/=(J& a, const J& b) {
  return a = a / b;
}

/// Jets compare by their values, so that branches take the way of the plain number.
template <Jet J>
auto operator<=>(const J& a, const J& b) {
  return a.value <=> b.value;
}
template <Jet J>
auto operator<=>(const J& a, const typename J::Scalar& b) {
  return a.value <=> b;
}
template <Jet J>
bool operator==(const J& a, const J& b) {
  return a.value == b.value;
}
template <Jet J>
bool operator==(const J& a, const typename J::Scalar& b) {
  return a.value == b;
}

template <Jet J>
J abs(const J& x) {
  return number(x) < 0.0 ? -x : x;
}
template <Jet J>
J sqrt(const J& x) {
  using std::sqrt;
  using S = typename J::Scalar;
  const S root = sqrt(x.value);
  const S d = 0.5 / root;
  return chain(x, root, d, S(-0.5 * d / x.value));
}
template <Jet J>
J exp(const J& x) {
  using std::exp;
  const typename J::Scalar e = exp(x.value);
  return chain(x, e, e, e);
}
template <Jet J>
J log(const J& x) {
  using std::log;
  using S = typename J::Scalar;
  const S i = 1.0 / x.value;
  return chain(x, S(log(x.value)), i, S(-i * i));
}
template <Jet J>
J sin(const J& x) {
  using std::cos;
  using std::sin;
  using S = typename J::Scalar;
  const S s = sin(x.value);
  return chain(x, s, S(cos(x.value)), S(-s));
}
template <Jet J>
J cos(const J& x) {
  using std::cos;
  using std::sin;
  using S = typename J::Scalar;
  const S c = cos(x.value);
  return chain(x, c, S(-sin(x.value)), S(-c));
}
template <Jet J>
J tan(const J& x) {
  using std::tan;
  using S = typename J::Scalar;
  const S t = tan(x.value);
  const S d = 1.0 + t * t;
  return chain(x, t, d, S(2.0 * t * d));
}
template <Jet J>
J asin(const J& x) {
  using std::asin;
  using std::sqrt;
  using S = typename J::Scalar;
  const S q = 1.0 / (1.0 - x.value * x.value);
  const S d = sqrt(q);
  return chain(x, S(asin(x.value)), d, S(x.value * d * q));
}
template <Jet J>
J acos(const J& x) {
  using std::acos;
  using std::sqrt;
  using S = typename J::Scalar;
  const S q = 1.0 / (1.0 - x.value * x.value);
  const S d = sqrt(q);
  return chain(x, S(acos(x.value)), S(-d), S(-x.value * d * q));
}
template <Jet J>
J atan(const J& x) {
  using std::atan;
  using S = typename J::Scalar;
  const S d = 1.0 / (1.0 + x.value * x.value);
  return chain(x, S(atan(x.value)), d, S(-2.0 * x.value * d * d));
}
template <Jet J>
J sinh(const J& x) {
  using std::cosh;
  using std::sinh;
  using S = typename J::Scalar;
  const S s = sinh(x.value);
  return chain(x, s, S(cosh(x.value)), s);
}
template <Jet J>
J cosh(const J& x) {
  using std::cosh;
  using std::sinh;
  using S = typename J::Scalar;
  const S c = cosh(x.value);
  return chain(x, c, S(sinh(x.value)), c);
}
template <Jet J>
J tanh(const J& x) {
  using std::tanh;
  using S = typename J::Scalar;
  const S t = tanh(x.value);
  const S d = 1.0 - t * t;
  return chain(x, t, d, S(-2.0 * t * d));
}

/// x^p for a constant p; x > 0, or p a small whole number.
template <Jet J>
J pow(const J& x, double p) {
  using std::pow;
  using S = typename J::Scalar;
  // Factors that vanish are skipped: 0 * pow(0, negative) would be NaN.
  const S d = p == 0.0 ? S(0.0) : S(p * pow(x.value, p - 1.0));
  const S dd = p == 0.0 || p == 1.0 ? S(0.0) : S(p * (p - 1.0) * pow(x.value, p - 2.0));
  return chain(x, S(pow(x.value, p)), d, dd);
}
/// x^y for x > 0.
template <Jet J>
J pow(const J& x, const J& y) {
  return exp(y * log(x));
}

/// Angle of the point (x, y), continuous across the quadrants.
template <Jet J>
J atan2(const J& y, const J& x) {
  using std::abs;
  using std::atan2;
  // The angle differs from that of a quotient with the larger denominator by a constant.
  const bool steep = abs(number(y)) > abs(number(x));
  J angle = steep ? -atan(x / y) : atan(y / x);
  angle.value = atan2(y.value, x.value);
  return angle;
}

}  // namespace muldi::math
