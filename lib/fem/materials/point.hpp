#pragma once
/// What a material sees at one point: deformation, field and rates; what it answers: stress, displacement, tangent.
///
/// All are templates of the scalar T: double, SIMD lanes (fem/kernel/lanes.hpp) or jets of either (math/jet.hpp).
/// Materials are additive: each law adds its share. A law has
///
///     name, doc                     as every component (base/describe.hpp),
///     T energy(point)               the energy by reference volume Omega(F, E): the readable formula,
///     void add_stress(point, s)     P = dOmega/dF, D = -dOmega/dE,
///     void add_tangent(point, t)    second derivatives by (F, E).
#include <cmath>
#include <concepts>

#include "math/jet.hpp"

namespace muldi::fem {

/// Calls f(integral_constant 0), ..., f(integral_constant n - 1), unrolled.
template <int n, class Function>
[[gnu::always_inline]] constexpr void unroll(const Function& f) {
  if constexpr (n > 0) {
    unroll<n - 1>(f);
    f(std::integral_constant<int, n - 1>{});
  }
}

/// The number itself where positive, else 1: states with J <= 0 are told by their smallest J, not by NaN.
inline double positive_or_one(double x) { return x > 0.0 ? x : 1.0; }
template <math::Jet T>
T positive_or_one(T x) {
  x.value = positive_or_one(x.value);
  return x;
}

/// x^(-1/3) for x > 0.
inline double inverse_cbrt(double x) { return 1.0 / std::cbrt(x); }
template <math::Jet T>
T inverse_cbrt(const T& x) {
  using S = typename T::Scalar;
  const S root = inverse_cbrt(x.value);
  const S slope = -root / (3.0 * x.value);
  return chain(x, root, slope, S(-4.0 / 3.0 * slope / x.value));
}

/// `limit`, or `value` where that is not positive and smaller.
inline double lowered(double limit, double value) { return value <= 0.0 && value < limit ? value : limit; }
template <math::Jet T>
T lowered(const T& limit, const T& value) {
  return T(lowered(limit.value, value.value));
}

/// inverse[k][i] of matrix[i][k] up to the factor 1/det, which is returned separately: the transposed cofactors.
template <class T>
[[gnu::always_inline]] inline T adjugate(const T (&m)[3][3], T (&adj)[3][3]) {
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int k = 0; k < 3; ++k) {
      const int k1 = (k + 1) % 3;
      const int k2 = (k + 2) % 3;
      adj[k][i] = m[i1][k1] * m[i2][k2] - m[i1][k2] * m[i2][k1];
    }
  }
  return m[0][0] * adj[0][0] + m[0][1] * adj[1][0] + m[0][2] * adj[2][0];
}

/// Deformation gradient, field and rate at a point.
template <class T>
struct Point {
  T F[3][3]{};       ///< dx/dX
  T E[3]{};          ///< -dphi/dX
  T F_rate[3][3]{};  ///< dF/dt
  T det{};           ///< det F
  T J{};             ///< det F, replaced by 1 where it is not positive
  T f[3][3]{};       ///< F^-1 (adjugate over J)

  /// Fills det, J and f from F.
  [[gnu::always_inline]] void complete() {
    det = adjugate(F, f);
    J = positive_or_one(det);
    const T inverse = 1.0 / J;
    for (auto& row : f)
      for (T& entry : row) entry = entry * inverse;
  }

  /// C : 1.
  T trace_C() const {
    T sum(0.0);
    for (const auto& row : F)
      for (const T& entry : row) sum = sum + entry * entry;
    return sum;
  }
};

/// First derivatives of the energy.
template <class T>
struct Stress {
  T P[3][3]{};  ///< first Piola-Kirchhoff stress, P[i][k] = dOmega/dF_ik
  T D[3]{};     ///< nominal electric displacement -dOmega/dE
  T limit{};    ///< det F, or a law's own margin once that is used up; the state is inadmissible if it is not positive
};

/// Second derivatives of the energy by pairs of the rows of (F; E), row 3 being E:
/// block[pair(I, J)][3 k + l], I <= J; of the symmetric blocks I = J only k <= l is kept.
template <class T>
struct Tangent {
  static constexpr int n_pairs = 10;
  T block[n_pairs][9]{};

  /// The mechanical pairs come first.
  static constexpr int pair(int i, int j) {
    constexpr int of[4][4] = {{0, 1, 2, 6}, {1, 3, 4, 7}, {2, 4, 5, 8}, {6, 7, 8, 9}};
    return of[i][j];
  }

  /// Adds entry(i, k, j, l) = d2Omega/dF_ik dF_jl; `entry` takes integral constants.
  template <class Entry>
  [[gnu::always_inline]] void add_FF(const Entry& entry) {
    unroll<3>([&](auto i) {
      unroll<3>([&](auto j) {
        if constexpr (i <= j) {
          unroll<9>([&](auto kl) {
            constexpr int k = kl / 3;
            constexpr int l = kl % 3;
            if constexpr (i < j || k <= l) {
              T& to = block[pair(i, j)][kl];
              to = to + entry(i, std::integral_constant<int, k>{}, j, std::integral_constant<int, l>{});
            }
          });
        }
      });
    });
  }
  /// Adds entry(i, k, m) = d2Omega/dF_ik dE_m.
  template <class Entry>
  [[gnu::always_inline]] void add_FE(const Entry& entry) {
    unroll<3>([&](auto i) {
      unroll<9>([&](auto km) {
        T& to = block[pair(i, 3)][km];
        to = to + entry(i, std::integral_constant<int, km / 3>{}, std::integral_constant<int, km % 3>{});
      });
    });
  }
  /// Adds entry(k, m) = d2Omega/dE_k dE_m.
  template <class Entry>
  [[gnu::always_inline]] void add_EE(const Entry& entry) {
    unroll<9>([&](auto km) {
      constexpr int k = km / 3;
      constexpr int m = km % 3;
      if constexpr (k <= m) {
        T& to = block[pair(3, 3)][km];
        to = to + entry(std::integral_constant<int, k>{}, std::integral_constant<int, m>{});
      }
    });
  }
};

}  // namespace muldi::fem
