#pragma once
/// Isochoric elasticity of Yeoh (Rubber Chem. Technol. 66, 1993), two terms.
#include <string_view>

#include "fem/materials/from_energy.hpp"

namespace muldi::fem {

/// mu/2 x + c/2 x^2 of x = J^(-2/3) C:1 - 3. FromEnergy makes stress and tangent of the energy alone.
struct YeohEnergy {
  static constexpr std::string_view name = "yeoh";
  static constexpr std::string_view doc = "isochoric elasticity that stiffens: mu/2 x + c/2 x^2, x = J^(-2/3) C:1 - 3";

  double mu = 0.0;  ///< shear modulus
  double c = 0.0;   ///< how much it stiffens

  template <class T>
  T energy(const Point<T>& at) const {
    const T root = inverse_cbrt(at.J);
    const T x = root * root * at.trace_C() - 3.0;
    return 0.5 * mu * x + 0.5 * c * x * x;
  }
};

using Yeoh = FromEnergy<YeohEnergy>;

}  // namespace muldi::fem
