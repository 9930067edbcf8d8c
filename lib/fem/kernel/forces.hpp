#pragma once
/// Forces of a batch and, with duals, their exact directional derivative.
#include "base/mutation.hpp"
#include "fem/kernel/batch.hpp"
#include "fem/kernel/law_calls.hpp"

namespace muldi::fem {

/// One batch of `forces` (T = lanes) or `action` (T = dual lanes).
template <class T>
class ForceBatch {
 public:
  using L = LanesOf<T>;

  ForceBatch(const ElementFields& fields, const FieldDirections& along, const Batch& batch)
      : gathered_(fields, along, batch), batch_(batch), pressed_(fields.pressure != nullptr) {
    if (pressed_) pressure_ = gathered_with<T>({fields.pressure, along.pressure, 1}, batch.elements, 0);
  }

  /// Sums over the Gauss points; the smallest det F or margin.
  L integrate(const BoundLaws<StressCall<T>>& laws) {
    for (auto& row : rows_) row.set_zero();
    L least(1e300);
    Point<T> at;
    for (int q = 0; q < 8; ++q) {
      const ReferenceMap<L> map(gathered_.X, q);
      volume_[q] = map.volume;
      gathered_.at(q, map, at);
      Stress<T> stress{};
      stress.limit = at.det;
      laws(at, stress);
      if (pressed_) {
        const T factor = pressure_ * at.J;
        for (int i = 0; i < 3; ++i)
          for (int m = 0; m < 3; ++m) stress.P[i][m] += factor * at.f[m][i];
      }
      least = smaller(least, plain(stress.limit));
      add_rows(q, map, stress);
    }
    return least;
  }

  void scatter(double density, const ForceTargets& to) {
    T nodal[8];
    if (to.force != nullptr) {
      for (int i = 0; i < 3; ++i) {
        rows_[i].nodal(nodal);
        scatter_row(nodal, 3, i, to.force);
      }
    }
    if (to.charge != nullptr && gathered_.charged) {
      rows_[3].nodal(nodal);
      scatter_row(nodal, 1, 0, to.charge);
    }
    if (to.momentum != nullptr && gathered_.moves) {
      for (int i = 0; i < 3; ++i) {
        T(&v)[8] = gathered_.v_nodes[i];
        to_gauss_points(v);
        for (int q = 0; q < 8; ++q) v[q] = v[q] * (density * volume_[q]);
        to_nodes(v);
        scatter_row(v, 3, i, to.momentum);
      }
    }
  }

 private:
  [[gnu::always_inline]] void add_rows(int q, const ReferenceMap<L>& map, const Stress<T>& stress) {
    for (int k = 0; k < 3; ++k) {
      L weighted[3];
      for (int m = 0; m < 3; ++m) weighted[m] = map.volume * map.inverse[k][m];
      for (int i = 0; i < 3; ++i) {
        rows_[i].add(q, k, stress.P[i][0] * weighted[0] + stress.P[i][1] * weighted[1] + stress.P[i][2] * weighted[2]);
      }
      if constexpr (base::has(base::Mutation::sign_of_displacement)) {
        for (L& weight : weighted) weight = -weight;
      }
      if (gathered_.charged) {
        rows_[3].add(q, k, stress.D[0] * weighted[0] + stress.D[1] * weighted[1] + stress.D[2] * weighted[2]);
      }
    }
  }

  void scatter_row(const T (&nodal)[8], int width, int component, double* to) const {
    L x[8];
    for (int a = 0; a < 8; ++a) x[a] = result(nodal[a]);
    scatter_nodes(x, batch_, width, component, to);
  }

  GatheredFields<T> gathered_;
  const Batch& batch_;
  bool pressed_;
  T pressure_{};
  ReferenceDivergence<T> rows_[4];
  L volume_[8];
};

template <class L>
double forces(const MaterialLaws& laws, const ElementRange& range, const ElementFields& fields,
              const ForceTargets& to) {
  const auto bound = bound_stresses<L>(laws, fields.phi != nullptr, fields.v != nullptr);
  L least(1e300);
  for (int b = 0; b < range.n_batches; ++b) {
    const Batch batch(range, b, L::size);
    ForceBatch<L> work(fields, {}, batch);
    const L of_batch = work.integrate(bound);
    work.scatter(laws.density, to);
    least = smaller(least, of_batch);
    if (to.least_J != nullptr) scatter_element(of_batch, batch, 1, 0, to.least_J);
  }
  return smallest(least);
}

template <class L>
void action(const MaterialLaws& laws, const ElementRange& range, const ElementFields& fields,
            const FieldDirections& along, const ForceTargets& to) {
  using T = math::Dual<L>;
  const auto bound = bound_stresses<T>(laws, fields.phi != nullptr, fields.v != nullptr);
  for (int b = 0; b < range.n_batches; ++b) {
    const Batch batch(range, b, L::size);
    ForceBatch<T> work(fields, along, batch);
    work.integrate(bound);
    work.scatter(laws.density, to);
  }
}

}  // namespace muldi::fem
