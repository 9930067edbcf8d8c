#pragma once
/// A SIMD value: N doubles, one an element of the mesh, as GCC and Clang vectors.
///
/// `isa` only makes types of different instruction sets different: code that is compiled several times must not share
/// functions, or the linker may keep the one that an old processor cannot run.
#include <cstdint>
#include <cstring>
#include <utility>

namespace muldi::fem {

/// Vectors of N doubles and integers; spelt out, since GCC ignores the attribute on types that depend on N.
template <int N>
struct VectorTypes;
template <>
struct VectorTypes<2> {
  using Vector = double __attribute__((vector_size(16)));
  using Bits = std::int64_t __attribute__((vector_size(16)));
  using Unsigned = std::uint64_t __attribute__((vector_size(16)));
};
template <>
struct VectorTypes<4> {
  using Vector = double __attribute__((vector_size(32)));
  using Bits = std::int64_t __attribute__((vector_size(32)));
  using Unsigned = std::uint64_t __attribute__((vector_size(32)));
};
template <>
struct VectorTypes<8> {
  using Vector = double __attribute__((vector_size(64)));
  using Bits = std::int64_t __attribute__((vector_size(64)));
  using Unsigned = std::uint64_t __attribute__((vector_size(64)));
};

template <int N, int isa>
struct Lanes {
  static constexpr int size = N;
  using Vector = typename VectorTypes<N>::Vector;
  using Bits = typename VectorTypes<N>::Bits;
  using Unsigned = typename VectorTypes<N>::Unsigned;

  Vector v;

  Lanes() = default;
  [[gnu::always_inline]] Lanes(double x) : v(x - Vector{}) {}  // NOLINT(google-explicit-constructor)
  [[gnu::always_inline]] explicit Lanes(Vector x) : v(x) {}

  /// Lane l.
  [[gnu::always_inline]] double operator[](int l) const { return v[l]; }
  [[gnu::always_inline]] void set(int l, double x) { v[l] = x; }

  [[gnu::always_inline]] static Lanes load(const double* from) {
    Lanes x;
    std::memcpy(&x.v, from, sizeof x.v);
    return x;
  }
  [[gnu::always_inline]] void store(double* to) const { std::memcpy(to, &v, sizeof v); }

  [[gnu::always_inline]] Lanes operator-() const { return Lanes(-v); }
  [[gnu::always_inline]] Lanes& operator+=(const Lanes& b) {
    v += b.v;
    return *this;
  }
  [[gnu::always_inline]] Lanes& operator-=(const Lanes& b) {
    v -= b.v;
    return *this;
  }
  [[gnu::always_inline]] Lanes& operator*=(const Lanes& b) {
    v *= b.v;
    return *this;
  }
  [[gnu::always_inline]] friend Lanes operator+(const Lanes& a, const Lanes& b) { return Lanes(a.v + b.v); }
  [[gnu::always_inline]] friend Lanes operator-(const Lanes& a, const Lanes& b) { return Lanes(a.v - b.v); }
  [[gnu::always_inline]] friend Lanes operator*(const Lanes& a, const Lanes& b) { return Lanes(a.v * b.v); }
  [[gnu::always_inline]] friend Lanes operator/(const Lanes& a, const Lanes& b) { return Lanes(a.v / b.v); }

  /// a where mask is set, else b.
  [[gnu::always_inline]] static Lanes choose(const Bits& mask, const Lanes& a, const Lanes& b) {
    return Lanes(Vector((Bits(a.v) & mask) | (Bits(b.v) & ~mask)));
  }
};

template <int N, int isa>
[[gnu::always_inline]] inline Lanes<N, isa> positive_or_one(const Lanes<N, isa>& x) {
  using L = Lanes<N, isa>;
  return L::choose(x.v > L(0.0).v, x, L(1.0));
}

/// The smaller one; NaN if x is.
template <int N, int isa>
[[gnu::always_inline]] inline Lanes<N, isa> smaller(const Lanes<N, isa>& least, const Lanes<N, isa>& x) {
  return Lanes<N, isa>::choose(x.v >= least.v, least, x);
}

template <int N, int isa>
[[gnu::always_inline]] inline Lanes<N, isa> lowered(const Lanes<N, isa>& limit, const Lanes<N, isa>& value) {
  using L = Lanes<N, isa>;
  return L::choose((value.v <= L(0.0).v) & (value.v < limit.v), value, limit);
}

/// Natural logarithm of normal x > 0, error below one unit in the last place (the method of fdlibm's e_log.c).
template <int N, int isa>
[[gnu::always_inline]] inline Lanes<N, isa> log(const Lanes<N, isa>& x) {
  using L = Lanes<N, isa>;
  using Bits = typename L::Bits;
  using Vector = typename L::Vector;
  // x = 2^k m with m in [sqrt(1/2), sqrt(2)); k comes from the exponent bits by way of a double with exponent 52.
  constexpr std::int64_t root_half = 0x3fe6a09e667f3bcd;
  constexpr std::int64_t bias = 1023;
  using Unsigned = typename L::Unsigned;
  const Bits bits = Bits(x.v);
  const Unsigned shifted = Unsigned(bits - root_half + (bias << 52)) >> 52;
  const L k = L(Vector(Bits(shifted) | 0x4330000000000000)) - (4503599627370496.0 + 1023.0);
  const L m(Vector(bits - ((Bits(shifted) - bias) << 52)));
  const L f = m - 1.0;
  const L s = f / (2.0 + f);
  const L z = s * s;
  const L w = z * z;
  const L even = w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const L odd = z * (6.666666666666735130e-01 +
                     w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  const L half = 0.5 * f * f;
  return k * 6.93147180369123816490e-01 - ((half - (s * (half + (even + odd)) + k * 1.90821492927058770002e-10)) - f);
}

/// x^(-1/3) of normal x > 0 to about one unit in the last place: a guess from the exponent bits, two steps of order
/// four.
template <int N, int isa>
[[gnu::always_inline]] inline Lanes<N, isa> inverse_cbrt(const Lanes<N, isa>& x) {
  using L = Lanes<N, isa>;
  using Bits = typename L::Bits;
  using Vector = typename L::Vector;
  using Unsigned = typename L::Unsigned;
  constexpr double two_52 = 4503599627370496.0;
  constexpr double guess = 1430188287.0;  // the upper word of the exponent arithmetic, 0x553ef0ff
  const L upper = L(Vector(Bits(Unsigned(x.v) >> 32) | 0x4330000000000000)) - two_52;
  const L word = (guess + two_52) - (1.0 / 3.0) * upper;
  L y(Vector(Bits(word.v) << 32));
  for (int step = 0; step < 2; ++step) {
    const L h = 1.0 - x * (y * y * y);
    y = y + y * h * (1.0 / 3.0 + h * (2.0 / 9.0 + h * (14.0 / 81.0)));
  }
  return y;
}

namespace transposition {

template <int stride, int half, std::size_t... lane>
[[gnu::always_inline]] inline auto mix(const auto& a, const auto& b, std::index_sequence<lane...>) {
  constexpr int n = sizeof...(lane);
  // Lane l of the result: bit `stride` of l picks a or b, half 0 takes the lower, half 1 the upper lanes of both.
  return __builtin_shufflevector(
      a, b,
      static_cast<int>((lane & stride) == 0 ? (lane & ~std::size_t{stride}) + half * stride
                                            : n + (lane & ~std::size_t{stride}) + half * stride)...);
}

}  // namespace transposition

/// Transposes N values of N lanes in registers.
template <int N, int isa>
[[gnu::always_inline]] inline void transpose(Lanes<N, isa> (&x)[N]) {
  const auto stage = [&x]<int stride>(std::integral_constant<int, stride>) __attribute__((always_inline)) {
    constexpr auto all = std::make_index_sequence<N>{};
    for (int i = 0; i < N; ++i) {
      if ((i & stride) != 0) continue;
      const auto a = x[i].v;
      const auto b = x[i + stride].v;
      x[i].v = transposition::mix<stride, 0>(a, b, all);
      x[i + stride].v = transposition::mix<stride, 1>(a, b, all);
    }
  };
  stage(std::integral_constant<int, 1>{});
  if constexpr (N >= 4) stage(std::integral_constant<int, 2>{});
  if constexpr (N >= 8) stage(std::integral_constant<int, 4>{});
}

}  // namespace muldi::fem
