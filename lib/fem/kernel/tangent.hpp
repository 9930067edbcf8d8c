#pragma once
/// The symmetric tangent of a batch.
#include "fem/kernel/batch.hpp"
#include "fem/kernel/contraction.hpp"
#include "fem/kernel/law_calls.hpp"

namespace muldi::fem {

/// What the tangents of all batches have in common: the laws that act, the state, the weights.
template <class L>
struct TangentTask {
  const ElementFields& fields;
  const ElementTangentWeights& weights;
  double mass;  ///< by volume, with its weight
  BoundLaws<TangentCall<L>> laws;
  RateTangentCall<L> rate = nullptr;
  const void* rate_law = nullptr;

  TangentTask(const MaterialLaws& of, const ElementFields& at, const ElementTangentWeights& by)
      : fields(at), weights(by), mass(by.mass * of.density) {
    const int n = fields.phi != nullptr ? of.n_energy : of.n_elastic;
    for (int i = 0; i < n; ++i) {
      laws.add(LawCalls<L, EnergyLaws>::tangent(of.energy[i].type), of.energy[i].law);
    }
    if (of.viscous.type >= 0 && weights.rate != 0.0) {
      rate = LawCalls<L, ViscousLaws>::rate_tangent(of.viscous.type);
      rate_law = of.viscous.law;
    }
  }
};

/// Element matrices of a batch by pairs of fields: entry [pair][8 a + b].
template <class L>
struct TangentBatch {
  L K[Tangent<L>::n_pairs][64];

  /// `n_fields`: 3 or 4 rows of unknowns a node.
  void integrate(const TangentTask<L>& task, const Batch& batch, int n_fields);

 private:
  void add_point(const Point<L>& at, const TangentTask<L>& task, const L& curvature, Tangent<L>& tangent) const;
  void pull_back_pairs(const Tangent<L>& tangent, const ReferenceMap<L>& map, const ElementTangentWeights& weights,
                       int q, int n_fields);
  void add_rank_one(const ElementTangentWeights& weights, const Batch& batch);

  PairTangent<L> hat_[Tangent<L>::n_pairs];
};

template <class L>
void TangentBatch<L>::add_point(const Point<L>& at, const TangentTask<L>& task, const L& curvature,
                                Tangent<L>& tangent) const {
  const ElementTangentWeights& weights = task.weights;
  if (weights.stiffness != 0.0 || weights.x_phi != 0.0 || weights.phi_phi != 0.0) task.laws(at, tangent);
  if (weights.stiffness != 1.0) {
    for (int pair = 0; pair < 6; ++pair)
      for (L& entry : tangent.block[pair]) entry = weights.stiffness * entry;
  }
  if (task.rate != nullptr) task.rate(task.rate_law, at, weights.rate, tangent);
  if (weights.curvature != nullptr) {
    const L factor = curvature * at.J;
    const auto& f = at.f;
    tangent.add_FF([&](auto i, auto k, auto j, auto l)
                       __attribute__((always_inline)) { return factor * (f[k][i] * f[l][j] - f[k][j] * f[l][i]); });
  }
}

template <class L>
void TangentBatch<L>::pull_back_pairs(const Tangent<L>& tangent, const ReferenceMap<L>& map,
                                      const ElementTangentWeights& weights, int q, int n_fields) {
  for (int i = 0; i < 3; ++i) {
    const int diagonal = Tangent<L>::pair(i, i);
    pull_back<true>(tangent.block[diagonal], map, map.volume, q, hat_[diagonal]);
    for (int j = i + 1; j < 3; ++j) {
      const int pair = Tangent<L>::pair(i, j);
      pull_back<false>(tangent.block[pair], map, map.volume, q, hat_[pair]);
    }
    if (n_fields == 4) {
      // E = -grad phi: one sign a derivative by E.
      const int pair = Tangent<L>::pair(i, 3);
      pull_back<false>(tangent.block[pair], map, -weights.x_phi * map.volume, q, hat_[pair]);
    }
  }
  if (n_fields == 4) {
    const int pair = Tangent<L>::pair(3, 3);
    pull_back<true>(tangent.block[pair], map, weights.phi_phi * map.volume, q, hat_[pair]);
  }
}

template <class L>
void TangentBatch<L>::add_rank_one(const ElementTangentWeights& weights, const Batch& batch) {
  const L weight = gathered<L>(weights.rank_one, batch.elements, 1, 0);
  L g[3][8];
  for (int i = 0; i < 3; ++i)
    for (int a = 0; a < 8; ++a)
      g[i][a] = gathered<L>(weights.volume_gradients, batch.elements, 24, 3 * corner_of_bits[a] + i);
  for (int i = 0; i < 3; ++i) {
    for (int a = 0; a < 8; ++a) {
      const L scaled = weight * g[i][a];
      for (int j = i; j < 3; ++j) {
        L* row = K[Tangent<L>::pair(i, j)] + 8 * a;
        for (int b = 0; b < 8; ++b) row[b] = row[b] + scaled * g[j][b];
      }
    }
  }
}

template <class L>
void TangentBatch<L>::integrate(const TangentTask<L>& task, const Batch& batch, int n_fields) {
  const ElementTangentWeights& weights = task.weights;
  const GatheredFields<L> gathered_fields({.X = task.fields.X, .x = task.fields.x, .phi = task.fields.phi}, {}, batch);
  const L curvature = weights.curvature == nullptr ? L(0.0) : gathered<L>(weights.curvature, batch.elements, 1, 0);
  L mass[8];
  Point<L> at;
  for (int q = 0; q < 8; ++q) {
    const ReferenceMap<L> map(gathered_fields.X, q);
    mass[q] = task.mass * map.volume;
    gathered_fields.at(q, map, at);
    Tangent<L> tangent{};
    add_point(at, task, curvature, tangent);
    pull_back_pairs(tangent, map, weights, q, n_fields);
  }
  walsh8(mass);
  for (int i = 0; i < n_fields; ++i) {
    for (int j = i; j < n_fields; ++j) {
      const int pair = Tangent<L>::pair(i, j);
      if (i == j) {
        modal_matrix<true>(hat_[pair], K[pair]);
        if (i < 3 && task.mass != 0.0) add_modal_mass(mass, K[pair]);
      } else {
        modal_matrix<false>(hat_[pair], K[pair]);
      }
      modes_to_nodes(K[pair]);
    }
  }
  if (weights.rank_one != nullptr) add_rank_one(weights, batch);
}

}  // namespace muldi::fem
