#pragma once
/// The volumetric energy that grows without bound towards J = 0 (numerics 1.2).
#include <string_view>

#include "fem/materials/volumetric.hpp"

namespace muldi::fem {

/// kappa/4 (J^2 - 1 - 2 ln J).
struct Logarithmic {
  static constexpr std::string_view name = "logarithmic";
  static constexpr std::string_view doc = "volumetric energy kappa/4 (J^2 - 1 - 2 ln J), unbounded towards J = 0";

  double kappa = 0.0;  ///< bulk modulus

  template <class T>
  T U(const T& J) const {
    using std::log;
    return 0.25 * kappa * (J * J - 1.0 - 2.0 * log(J));
  }
  template <class T>
  T dU_dJ(const T& J) const {
    return 0.5 * kappa * (J - 1.0 / J);
  }
  template <class T>
  T d2U_dJdJ(const T& J) const {
    return 0.5 * kappa * (1.0 + 1.0 / (J * J));
  }

  template <class T>
  T energy(const Point<T>& at) const {
    return U(at.J);
  }
  template <class T>
  void add_stress(const Point<T>& at, Stress<T>& out) const {
    add_volumetric_stress(*this, at, out);
  }
  template <class T>
  void add_tangent(const Point<T>& at, Tangent<T>& out) const {
    add_volumetric_tangent(*this, at, out);
  }
};

}  // namespace muldi::fem
