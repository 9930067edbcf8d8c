#pragma once
/// Stress and tangent of a law that gives its energy alone, by jets over the twelve entries of (F, E).
#include "fem/materials/point.hpp"
#include "math/jet.hpp"

namespace muldi::fem {

/// `Law` has name, doc and `energy`; what it has of derivatives is not used. Several times slower than hand-written
/// derivatives, exact to round-off, and good for SIMD lanes too: a research law is `FromEnergy<Mine>` in the registry.
template <class Law>
struct FromEnergy : Law {
  FromEnergy() = default;
  explicit FromEnergy(const Law& law) : Law(law) {}

  template <class T>
  void add_stress(const Point<T>& at, Stress<T>& out) const {
    // One direction after the other: gradients without second derivatives.
    for (int variable = 0; variable < 12; ++variable) {
      Point<math::Dual<T>> seeded;
      for (int n = 0; n < 12; ++n) entry_of(seeded, n) = math::Dual<T>(entry_of(at, n), T(n == variable ? 1.0 : 0.0));
      seeded.complete();
      const T slope = Law::energy(seeded).slope;
      if (variable < 9) {
        T& to = out.P[variable / 3][variable % 3];
        to = to + slope;
      } else {
        out.D[variable - 9] = out.D[variable - 9] - slope;
      }
    }
  }

  template <class T>
  void add_tangent(const Point<T>& at, Tangent<T>& out) const {
    using Jet = math::Jet2<12, T>;
    Point<Jet> seeded;
    for (int n = 0; n < 12; ++n) entry_of(seeded, n) = Jet::variable(entry_of(at, n), n);
    seeded.complete();
    const Jet energy = Law::energy(seeded);
    for (int row = 0; row < 4; ++row) {
      for (int column = row; column < 4; ++column) {
        T* block = out.block[Tangent<T>::pair(row, column)];
        for (int k = 0; k < 3; ++k) {
          for (int l = row == column ? k : 0; l < 3; ++l) {
            block[3 * k + l] = block[3 * k + l] + energy.dd(3 * row + k, 3 * column + l);
          }
        }
      }
    }
  }

 private:
  /// Entry n of (F by rows, E).
  template <class P>
  static auto& entry_of(P& point, int n) {
    return n < 9 ? point.F[n / 3][n % 3] : point.E[n - 9];
  }
};

}  // namespace muldi::fem
