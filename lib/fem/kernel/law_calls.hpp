#pragma once
/// The laws of a material as function pointers for one scalar: a call a law, Gauss point and batch.
///
/// What is compiled is the sum of the laws, not the product of their combinations.
#include "fem/material.hpp"

namespace muldi::fem {

template <class T>
using StressCall = void (*)(const void* law, const Point<T>& at, Stress<T>& out);
template <class T>
using TangentCall = void (*)(const void* law, const Point<T>& at, Tangent<T>& out);
template <class T>
using RateTangentCall = void (*)(const void* law, const Point<T>& at, double weight, Tangent<T>& out);
template <class T>
using EnergyCall = void (*)(const void* law, const Point<T>& at, T& out);

/// The tables over a list of laws, in its order.
template <class T, class List>
struct LawCalls;
template <class T, class... Laws>
struct LawCalls<T, base::TypeList<Laws...>> {
  template <class Law>
  static void add_stress(const void* law, const Point<T>& at, Stress<T>& out) {
    static_cast<const Law*>(law)->add_stress(at, out);
  }
  template <class Law>
  static void add_tangent(const void* law, const Point<T>& at, Tangent<T>& out) {
    static_cast<const Law*>(law)->add_tangent(at, out);
  }
  template <class Law>
  static void add_rate_tangent(const void* law, const Point<T>& at, double weight, Tangent<T>& out) {
    static_cast<const Law*>(law)->add_rate_tangent(at, weight, out);
  }
  template <class Law>
  static void energy(const void* law, const Point<T>& at, T& out) {
    out = static_cast<const Law*>(law)->energy(at);
  }
  template <class Law>
  static void dissipation(const void* law, const Point<T>& at, T& out) {
    out = static_cast<const Law*>(law)->dissipation(at);
  }

  static StressCall<T> stress(int type) {
    static constexpr StressCall<T> calls[] = {&add_stress<Laws>...};
    return calls[type];
  }
  static TangentCall<T> tangent(int type) {
    static constexpr TangentCall<T> calls[] = {&add_tangent<Laws>...};
    return calls[type];
  }
  static RateTangentCall<T> rate_tangent(int type) {
    static constexpr RateTangentCall<T> calls[] = {&add_rate_tangent<Laws>...};
    return calls[type];
  }
  static EnergyCall<T> energy(int type) {
    static constexpr EnergyCall<T> calls[] = {&energy<Laws>...};
    return calls[type];
  }
  static EnergyCall<T> dissipation(int type) {
    static constexpr EnergyCall<T> calls[] = {&dissipation<Laws>...};
    return calls[type];
  }
};

/// Calls ready to make, of the laws that act: the electric one if there is a field, the viscous one if there is motion.
template <class Call>
struct BoundLaws {
  int n = 0;
  Call call[4];
  const void* law[4];

  void add(Call function, const void* parameters) {
    call[n] = function;
    law[n] = parameters;
    ++n;
  }
  template <class... Arguments>
  [[gnu::always_inline]] void operator()(Arguments&&... arguments) const {
    for (int i = 0; i < n; ++i) call[i](law[i], arguments...);
  }
};

/// All stresses that act.
template <class T>
BoundLaws<StressCall<T>> bound_stresses(const MaterialLaws& laws, bool charged, bool moves) {
  BoundLaws<StressCall<T>> bound;
  const int n = charged ? laws.n_energy : laws.n_elastic;
  for (int i = 0; i < n; ++i) bound.add(LawCalls<T, EnergyLaws>::stress(laws.energy[i].type), laws.energy[i].law);
  if (moves && laws.viscous.type >= 0) {
    bound.add(LawCalls<T, ViscousLaws>::stress(laws.viscous.type), laws.viscous.law);
  }
  return bound;
}

}  // namespace muldi::fem
