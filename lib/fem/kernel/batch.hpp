#pragma once
/// One batch of elements in registers: gathered fields, and what is scattered back.
#include "fem/kernel/element_kernels.hpp"
#include "fem/kernel/hexahedron.hpp"
#include "fem/kernel/lanes.hpp"
#include "math/jet.hpp"

namespace muldi::fem {

/// The lanes under a scalar of the kernels, which is L or Dual<L>.
template <class T>
struct LanesUnder {
  using type = T;
};
template <class L>
struct LanesUnder<math::Dual<L>> {
  using type = L;
};
template <class T>
using LanesOf = typename LanesUnder<T>::type;

template <class L>
[[gnu::always_inline]] inline const L& plain(const L& x) {
  return x;
}
template <class L>
[[gnu::always_inline]] inline const L& plain(const math::Dual<L>& x) {
  return x.value;
}
/// What a kernel adds: the value, or the derivative of a dual.
template <class L>
[[gnu::always_inline]] inline const L& result(const L& x) {
  return x;
}
template <class L>
[[gnu::always_inline]] inline const L& result(const math::Dual<L>& x) {
  return x.slope;
}

/// The addresses of one batch.
struct Batch {
  const int* nodes;     ///< [8][lane]
  const int* elements;  ///< [lane]
  int active;
  int index;  ///< in the whole order

  Batch(const ElementRange& range, int b, int lanes)
      : nodes(range.nodes + 8L * lanes * b),
        elements(range.elements + static_cast<long>(lanes) * b),
        active(range.active[b]),
        index(range.first_batch + b) {}
};

/// values[width index_l + component] of all lanes.
template <class L>
[[gnu::always_inline]] inline L gathered(const double* values, const int* index, int width, int component) {
  L x;
  for (int lane = 0; lane < L::size; ++lane) x.set(lane, values[static_cast<long>(width) * index[lane] + component]);
  return x;
}

/// An array with `width` entries a node or element, and a direction in its space (null: zero).
struct Source {
  const double* values = nullptr;
  const double* direction = nullptr;
  int width = 1;
};

/// The same with the derivative along the direction where T is a dual.
template <class T>
[[gnu::always_inline]] inline T gathered_with(const Source& from, const int* index, int component) {
  using L = LanesOf<T>;
  const L value = gathered<L>(from.values, index, from.width, component);
  if constexpr (math::Jet<T>) {
    return T(value, from.direction == nullptr ? L(0.0) : gathered<L>(from.direction, index, from.width, component));
  } else {
    return value;
  }
}

/// Component `component` of a nodal array at the eight nodes.
template <class T>
inline void gather_nodes(const Source& from, const Batch& batch, int component, T (&x)[8]) {
  for (int a = 0; a < 8; ++a) x[a] = gathered_with<T>(from, batch.nodes + a * LanesOf<T>::size, component);
}

/// values[width node + component] += x_a.
template <class L>
inline void scatter_nodes(const L (&x)[8], const Batch& batch, int width, int component, double* values) {
  for (int a = 0; a < 8; ++a) {
    const int* nodes = batch.nodes + a * L::size;
    for (int lane = 0; lane < batch.active; ++lane)
      values[static_cast<long>(width) * nodes[lane] + component] += x[a][lane];
  }
}

/// values[element] = x.
template <class L>
inline void scatter_element(const L& x, const Batch& batch, long width, long entry, double* values) {
  for (int lane = 0; lane < batch.active; ++lane) values[width * batch.elements[lane] + entry] = x[lane];
}

/// Smallest entry over the lanes; NaN if one is.
template <class L>
double smallest(const L& x) {
  double least = x[0];
  for (int lane = 1; lane < L::size; ++lane) least = x[lane] >= least ? least : x[lane];
  return least;
}

/// The fields of a batch as gradients by reference coordinates.
template <class T>
struct GatheredFields {
  using L = LanesOf<T>;
  bool moves = false;
  bool charged = false;
  ReferenceGradient<L> X[3];
  ReferenceGradient<T> x[3];
  ReferenceGradient<T> v[3];
  ReferenceGradient<T> phi;
  T v_nodes[3][8];

  GatheredFields(const ElementFields& from, const FieldDirections& along, const Batch& batch)
      : moves(from.v != nullptr), charged(from.phi != nullptr) {
    for (int i = 0; i < 3; ++i) {
      L position[8];
      gather_nodes<L>({from.X, nullptr, 3}, batch, i, position);
      X[i] = ReferenceGradient<L>(position);
      T nodal[8];
      gather_nodes<T>({from.x, along.x, 3}, batch, i, nodal);
      x[i] = ReferenceGradient<T>(nodal);
      if (moves) {
        gather_nodes<T>({from.v, along.v, 3}, batch, i, v_nodes[i]);
        for (int a = 0; a < 8; ++a) nodal[a] = v_nodes[i][a];
        v[i] = ReferenceGradient<T>(nodal);
      }
    }
    if (charged) {
      T nodal[8];
      gather_nodes<T>({from.phi, along.phi, 1}, batch, 0, nodal);
      phi = ReferenceGradient<T>(nodal);
    }
  }

  /// Deformation, field and rate at a Gauss point.
  [[gnu::always_inline]] void at(int q, const ReferenceMap<L>& map, Point<T>& point) const {
    for (int i = 0; i < 3; ++i)
      for (int m = 0; m < 3; ++m) point.F[i][m] = map.gradient(x[i], q, m);
    if (moves) {
      for (int i = 0; i < 3; ++i)
        for (int m = 0; m < 3; ++m) point.F_rate[i][m] = map.gradient(v[i], q, m);
    }
    if (charged) {
      for (int m = 0; m < 3; ++m) point.E[m] = -map.gradient(phi, q, m);
    }
    point.complete();
  }
};

}  // namespace muldi::fem
