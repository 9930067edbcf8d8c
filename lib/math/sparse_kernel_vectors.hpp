#pragma once
/// Vector types of the kernels, for the instruction set of the including file, which defines MULDI_LANES (doubles in a
/// vector).
///
/// Nothing of the standard library or Eigen may be instantiated in the kernels: the linker could take such a copy, made
/// for a new processor, for the whole program.
#include "math/sparse_kernels.hpp"

namespace muldi::math::kernels {
namespace {

inline constexpr int lanes = MULDI_LANES;
// Tiles of C = A B: rows in vectors, columns. The accumulators and one column of A fill the registers.
inline constexpr int tile_vectors = lanes == 2 ? 2 : 3;
inline constexpr int tile_columns = lanes == 8 ? 8 : 4;
inline constexpr int tile_rows = tile_vectors * lanes;
static_assert(pack_rows % tile_rows == 0 && row_multiple % lanes == 0);

// NOLINTBEGIN(modernize-use-using): attributes
typedef double VectorD __attribute__((vector_size(8 * MULDI_LANES), may_alias));
typedef VectorD LooseD __attribute__((aligned(8)));
typedef float VectorF __attribute__((vector_size(8 * MULDI_LANES), may_alias));
typedef VectorF LooseF __attribute__((aligned(4)));
typedef double Vector4D __attribute__((vector_size(32), may_alias));
typedef Vector4D Loose4D __attribute__((aligned(8)));
typedef float Vector4F __attribute__((vector_size(16), may_alias));
typedef Vector4F Loose4F __attribute__((aligned(4)));
// NOLINTEND(modernize-use-using)

template <class Scalar>
struct Vectors;
template <>
struct Vectors<double> {
  using V = VectorD;
  using Loose = LooseD;
  using V4 = Vector4D;
  using Loose4 = Loose4D;
  static constexpr int n = lanes;
};
template <>
struct Vectors<float> {
  using V = VectorF;
  using Loose = LooseF;
  using V4 = Vector4F;
  using Loose4 = Loose4F;
  static constexpr int n = 2 * lanes;
};

inline VectorD load(const double* p) { return *reinterpret_cast<const LooseD*>(p); }
inline void store(double* p, VectorD v) { *reinterpret_cast<LooseD*>(p) = v; }
inline VectorF load(const float* p) { return *reinterpret_cast<const LooseF*>(p); }
inline void store(float* p, VectorF v) { *reinterpret_cast<LooseF*>(p) = v; }
inline Vector4D load4(const double* p) { return *reinterpret_cast<const Loose4D*>(p); }
inline void store4(double* p, Vector4D v) { *reinterpret_cast<Loose4D*>(p) = v; }
inline Vector4F load4(const float* p) { return *reinterpret_cast<const Loose4F*>(p); }
inline void store4(float* p, Vector4F v) { *reinterpret_cast<Loose4F*>(p) = v; }

template <class Scalar>
inline auto splat(Scalar x) {
  using V = typename Vectors<Scalar>::V;
  if constexpr (Vectors<Scalar>::n == 2) {
    return V{x, x};
  } else if constexpr (Vectors<Scalar>::n == 4) {
    return V{x, x, x, x};
  } else if constexpr (Vectors<Scalar>::n == 8) {
    return V{x, x, x, x, x, x, x, x};
  } else {
    return V{x, x, x, x, x, x, x, x, x, x, x, x, x, x, x, x};
  }
}

template <class Scalar>
inline auto splat4(Scalar x) {
  return typename Vectors<Scalar>::V4{x, x, x, x};
}

constexpr int smaller(int a, int b) { return a < b ? a : b; }
constexpr int rounded_down(int i) { return i / row_multiple * row_multiple; }
constexpr int rounded_up(int i) { return rounded_down(i + row_multiple - 1); }

}  // namespace
}  // namespace muldi::math::kernels
