#pragma once
/// Volumes with their derivatives, energies, values at points, masses and loads.
#include "fem/kernel/batch.hpp"
#include "fem/kernel/law_calls.hpp"

namespace muldi::fem {

/// Weighted reference volumes of the Gauss points.
template <class L>
void point_volumes(const double* X, const Batch& batch, L (&volume)[8]) {
  ReferenceGradient<L> at_rest[3];
  for (int i = 0; i < 3; ++i) {
    L position[8];
    gather_nodes<L>({X, nullptr, 3}, batch, i, position);
    at_rest[i] = ReferenceGradient<L>(position);
  }
  for (int q = 0; q < 8; ++q) volume[q] = ReferenceMap<L>(at_rest, q).volume;
}

/// V_e of a batch.
template <class L>
L reference_volume(const double* X, const Batch& batch) {
  L volume[8];
  point_volumes(X, batch, volume);
  L sum(0.0);
  for (const L& part : volume) sum += part;
  return sum;
}

/// J_e and g_e of a batch; T is a dual for derivatives along a direction.
template <class T>
struct VolumeBatch {
  using L = LanesOf<T>;
  L reference{};
  T J{};
  T gradient[3][8];

  VolumeBatch(const VolumeFields& fields, const Batch& batch) {
    ReferenceGradient<T> deformed[3];
    for (int i = 0; i < 3; ++i) {
      T nodal[8];
      gather_nodes<T>({fields.x, fields.dx, 3}, batch, i, nodal);
      deformed[i] = ReferenceGradient<T>(nodal);
    }
    ReferenceDivergence<T> rows[3];
    for (auto& row : rows) row.set_zero();
    for (int q = 0; q < 8; ++q) {
      T h[3][3];
      T cofactor[3][3];
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) h[i][k] = deformed[i].at(q, k);
      J += adjugate(h, cofactor);
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) rows[i].add(q, k, cofactor[k][i]);
    }
    reference =
        fields.V != nullptr ? gathered<L>(fields.V, batch.elements, 1, 0) : reference_volume<L>(fields.X, batch);
    const L inverse = 1.0 / reference;
    J = J * inverse;
    for (int i = 0; i < 3; ++i) {
      rows[i].nodal(gradient[i]);
      for (T& entry : gradient[i]) entry = entry * inverse;
    }
  }
};

/// [element][8][3], element by element: the addresses of one are computed once.
template <class T>
void scatter_gradient(const T (&gradient)[3][8], const Batch& batch, double* to) {
  for (int lane = 0; lane < batch.active; ++lane) {
    double* const of_element = to + 24L * batch.elements[lane];
    for (int i = 0; i < 3; ++i)
      for (int a = 0; a < 8; ++a) of_element[3 * corner_of_bits[a] + i] = result(gradient[i][a])[lane];
  }
}

template <class L>
void volumes(const ElementRange& range, const VolumeFields& fields, const VolumeTargets& to) {
  VolumeFields without_direction = fields;
  without_direction.dx = nullptr;
  for (int b = 0; b < range.n_batches; ++b) {
    const Batch batch(range, b, L::size);
    const VolumeBatch<L> at(without_direction, batch);
    if (to.reference != nullptr) scatter_element(at.reference, batch, 1, 0, to.reference);
    if (to.J != nullptr) scatter_element(at.J, batch, 1, 0, to.J);
    if (to.gradient != nullptr) scatter_gradient(at.gradient, batch, to.gradient);
    if (fields.dx == nullptr || (to.dJ == nullptr && to.dgradient == nullptr)) continue;
    const VolumeBatch<math::Dual<L>> along(fields, batch);
    if (to.dJ != nullptr) scatter_element(along.J.slope, batch, 1, 0, to.dJ);
    if (to.dgradient != nullptr) scatter_gradient(along.gradient, batch, to.dgradient);
  }
}

template <class L>
double sum_of_lanes(const L& x, int active) {
  double sum = 0.0;
  for (int lane = 0; lane < active; ++lane) sum += x[lane];
  return sum;
}

/// 1/2 v.M v of a batch; uses up v.
template <class L>
L kinetic_energy(L (&v)[3][8], const L (&volume)[8], double density) {
  L sum(0.0);
  for (int i = 0; i < 3; ++i) {
    to_gauss_points(v[i]);
    for (int q = 0; q < 8; ++q) sum += volume[q] * (v[i][q] * v[i][q]);
  }
  return 0.5 * density * sum;
}

template <class L>
ElementEnergies energies(const MaterialLaws& laws, const ElementRange& range, const ElementFields& fields) {
  using Calls = LawCalls<L, EnergyLaws>;
  ElementEnergies sum;
  for (int b = 0; b < range.n_batches; ++b) {
    const Batch batch(range, b, L::size);
    GatheredFields<L> gathered_fields(fields, {}, batch);
    L elastic(0.0);
    L electric(0.0);
    L dissipation(0.0);
    L deformed(0.0);
    L volume[8];
    Point<L> at;
    for (int q = 0; q < 8; ++q) {
      const ReferenceMap<L> map(gathered_fields.X, q);
      volume[q] = map.volume;
      gathered_fields.at(q, map, at);
      deformed += map.volume * at.det;
      for (int n = 0; n < (fields.phi != nullptr ? laws.n_energy : laws.n_elastic); ++n) {
        L value;
        Calls::energy(laws.energy[n].type)(laws.energy[n].law, at, value);
        (n < laws.n_elastic ? elastic : electric) += map.volume * value;
      }
      if (fields.v != nullptr && laws.viscous.type >= 0) {
        L value;
        LawCalls<L, ViscousLaws>::dissipation(laws.viscous.type)(laws.viscous.law, at, value);
        dissipation += map.volume * value;
      }
    }
    sum.elastic += sum_of_lanes(elastic, batch.active);
    sum.electric += sum_of_lanes(electric, batch.active);
    sum.dissipation += sum_of_lanes(dissipation, batch.active);
    sum.volume += sum_of_lanes(deformed, batch.active);
    if (fields.v != nullptr) {
      sum.kinetic += sum_of_lanes(kinetic_energy(gathered_fields.v_nodes, volume, laws.density), batch.active);
    }
  }
  return sum;
}

/// P F^T/J in the order of PointValues.
template <class L>
void cauchy_stress(const Point<L>& at, const Stress<L>& stress, L (&cauchy)[6]) {
  constexpr int row[6] = {0, 1, 2, 1, 0, 0};
  constexpr int column[6] = {0, 1, 2, 2, 2, 1};
  for (int n = 0; n < 6; ++n) {
    const L* P = stress.P[row[n]];
    const L* F = at.F[column[n]];
    cauchy[n] = (P[0] * F[0] + P[1] * F[1] + P[2] * F[2]) / at.J;
  }
}

template <class L>
void store_point(const Point<L>& at, const Stress<L>& stress, const L& volume, int lane, PointValues& to) {
  L cauchy[6];
  cauchy_stress(at, stress, cauchy);
  for (int n = 0; n < 6; ++n) to.cauchy[n] = cauchy[n][lane];
  for (int i = 0; i < 3; ++i) {
    to.D[i] = stress.D[i][lane];
    to.field[i] = (at.f[0][i] * at.E[0] + at.f[1][i] * at.E[1] + at.f[2][i] * at.E[2])[lane];
    for (int k = 0; k < 3; ++k) {
      to.F[3 * i + k] = at.F[i][k][lane];
      to.P[3 * i + k] = stress.P[i][k][lane];
    }
  }
  to.J = at.det[lane];
  to.volume = volume[lane];
}

template <class L>
void point_values(const MaterialLaws& laws, const ElementRange& range, const ElementFields& fields, PointValues* to) {
  const auto bound = bound_stresses<L>(laws, fields.phi != nullptr, fields.v != nullptr);
  for (int b = 0; b < range.n_batches; ++b) {
    const Batch batch(range, b, L::size);
    const GatheredFields<L> gathered_fields(fields, {}, batch);
    const L pressure = fields.pressure == nullptr ? L(0.0) : gathered<L>(fields.pressure, batch.elements, 1, 0);
    L X[3][8];
    for (int i = 0; i < 3; ++i) {
      gather_nodes<L>({fields.X, nullptr, 3}, batch, i, X[i]);
      to_gauss_points(X[i]);
    }
    Point<L> at;
    for (int q = 0; q < 8; ++q) {
      const ReferenceMap<L> map(gathered_fields.X, q);
      gathered_fields.at(q, map, at);
      Stress<L> stress{};
      bound(at, stress);
      for (int i = 0; i < 3; ++i)
        for (int m = 0; m < 3; ++m) stress.P[i][m] += pressure * at.J * at.f[m][i];
      for (int lane = 0; lane < batch.active; ++lane) {
        PointValues& point = to[8L * batch.elements[lane] + q];
        for (int i = 0; i < 3; ++i) point.X[i] = X[i][q][lane];
        store_point(at, stress, map.volume, lane, point);
      }
    }
  }
}

template <class L>
void mass(const ElementRange& range, const double* X, double* matrices) {
  for (int b = 0; b < range.n_batches; ++b) {
    const Batch batch(range, b, L::size);
    L volume[8];
    point_volumes(X, batch, volume);
    for (int column = 0; column < 8; ++column) {
      L unit[8];
      for (int a = 0; a < 8; ++a) unit[a] = L(a == column ? 1.0 : 0.0);
      to_gauss_points(unit);
      for (int q = 0; q < 8; ++q) unit[q] = unit[q] * volume[q];
      to_nodes(unit);
      for (int a = 0; a < 8; ++a) {
        scatter_element(unit[a], batch, 64, 8 * corner_of_bits[a] + corner_of_bits[column], matrices);
      }
    }
  }
}

template <class L>
void loads(const ElementRange& range, const double* X, const double* b, int width, double* nodal) {
  for (int n = 0; n < range.n_batches; ++n) {
    const Batch batch(range, n, L::size);
    L volume[8];
    point_volumes(X, batch, volume);
    for (int component = 0; component < width; ++component) {
      L value[8];
      for (int q = 0; q < 8; ++q) {
        value[q] =
            b == nullptr ? volume[q] : volume[q] * gathered<L>(b, batch.elements, 8 * width, q * width + component);
      }
      to_nodes(value);
      scatter_nodes(value, batch, width, component, nodal);
    }
  }
}

}  // namespace muldi::fem
