#pragma once
/// Loops over long vectors in fixed chunks: the same bits for any number of threads.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "base/parallel.hpp"

namespace muldi::math {

/// Chunks of a loop over n entries: by the length alone.
constexpr int n_vector_chunks(std::ptrdiff_t n) {
  return static_cast<int>(std::clamp<std::ptrdiff_t>(n / 16384, 1, 32));
}

/// Calls f(first, length) for the chunks of 0..n-1.
template <class F>
void for_vector_chunks(std::ptrdiff_t n, F&& f) {
  const int count = n_vector_chunks(n);
  base::parallel_for(count, [&](int c) {
    const base::ChunkRange range = base::chunk_range(n, count, c);
    f(range.first, range.last - range.first);
  });
}

/// The sum over the chunks of f(first, length), added in their order.
template <class F>
double sum_over_vector_chunks(std::ptrdiff_t n, F&& f) {
  std::array<double, 32> parts{};
  const int count = n_vector_chunks(n);
  base::parallel_for(count, [&](int c) {
    const base::ChunkRange range = base::chunk_range(n, count, c);
    parts[static_cast<std::size_t>(c)] = f(range.first, range.last - range.first);
  });
  double sum = 0.0;
  for (int c = 0; c < count; ++c) sum += parts[static_cast<std::size_t>(c)];
  return sum;
}

/// x . y
template <class X, class Y>
double dot(const X& x, const Y& y) {
  return sum_over_vector_chunks(x.size(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    return static_cast<double>(x.segment(first, n).dot(y.segment(first, n)));
  });
}

/// Entry i of a vector without structure, in [-1, 1): a start for eigenvalue estimates (splitmix64).
constexpr double rough_entry(std::ptrdiff_t i) {
  std::uint64_t z = (static_cast<std::uint64_t>(i) + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
}

/// y += a x
template <class X, class Y>
void add_scaled(Y& y, typename Y::Scalar a, const X& x) {
  for_vector_chunks(x.size(),
                    [&](std::ptrdiff_t first, std::ptrdiff_t n) { y.segment(first, n) += a * x.segment(first, n); });
}

}  // namespace muldi::math
