#pragma once
/// Constant permittivity in the deformed material (numerics 1.2, `ideal`).
#include <string_view>

#include "fem/materials/true_field.hpp"

namespace muldi::fem {

/// -1/2 eps J E.C^-1.E.
struct IdealDielectric {
  static constexpr std::string_view name = "ideal_dielectric";
  static constexpr std::string_view doc = "constant permittivity in the deformed material";

  double permittivity = 0.0;  ///< eps = eps0 eps_r

  template <class T>
  T energy(const Point<T>& at) const {
    return -0.5 * permittivity * at.J * TrueField<T>(at).square;
  }
  template <class T>
  void add_stress(const Point<T>& at, Stress<T>& out) const {
    field_energy().add_stress(at, out);
  }
  template <class T>
  void add_tangent(const Point<T>& at, Tangent<T>& out) const {
    field_energy().add_tangent(at, out);
  }

 private:
  FieldEnergy field_energy() const { return {.alpha = -0.5 * permittivity, .beta = 0.0}; }
};

}  // namespace muldi::fem
