#pragma once
/// The volumetric energy of the thesis (numerics 1.2).
#include <string_view>

#include "fem/materials/volumetric.hpp"

namespace muldi::fem {

/// kappa/2 (J - 1)^2.
struct Quadratic {
  static constexpr std::string_view name = "quadratic";
  static constexpr std::string_view doc = "volumetric energy kappa/2 (J - 1)^2";

  double kappa = 0.0;  ///< bulk modulus

  template <class T>
  T U(const T& J) const {
    return 0.5 * kappa * (J - 1.0) * (J - 1.0);
  }
  template <class T>
  T dU_dJ(const T& J) const {
    return kappa * (J - 1.0);
  }
  template <class T>
  T d2U_dJdJ(const T& /*J*/) const {
    return T(kappa);
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
