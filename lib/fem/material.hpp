#pragma once
/// A material as the kernels take it: a sum of laws.
#include <array>
#include <optional>

#include "fem/registry.hpp"

namespace muldi::fem {

/// Elastic + volumetric + electric + viscous law, each with plain parameters.
struct Material {
  double density = 0.0;
  base::VariantOf<ElasticLaws> elastic = {};
  /// Only in the displacement formulation; the others take it at the element's mean dilatation.
  std::optional<base::VariantOf<VolumetricLaws>> volumetric = {};
  std::optional<base::VariantOf<ElectricLaws>> electric = {};
  std::optional<base::VariantOf<ViscousLaws>> viscous = {};
};

/// One law: its number in its list, and its parameters.
struct LawReference {
  int type = -1;
  const void* law = nullptr;
};

/// The laws of a material as numbers and addresses: what crosses into code for one instruction set.
struct MaterialLaws {
  double density = 0.0;
  LawReference energy[3] = {};  ///< in EnergyLaws; the first `n_elastic` mechanical, then the electric one
  int n_energy = 0;
  int n_elastic = 0;
  LawReference viscous = {};  ///< in ViscousLaws; type -1: none
};

/// Two lists as one.
template <class... Lists>
struct Joined;
template <class... A, class... B, class... Lists>
struct Joined<base::TypeList<A...>, base::TypeList<B...>, Lists...> : Joined<base::TypeList<A..., B...>, Lists...> {};
template <class List>
struct Joined<List> {
  using type = List;
};

/// All laws with an energy.
using EnergyLaws = typename Joined<ElasticLaws, VolumetricLaws, ElectricLaws>::type;

/// References into `material`, which must stay where it is.
MaterialLaws laws_of(const Material& material);
MaterialLaws laws_of(Material&&) = delete;

/// Largest eigenvalue of d2Omega/dE2 of the electric law at the deformation gradient F (by rows) and the field E:
/// negative for a physical dielectric, whose energy is concave in E (numerics 1.2); -infinity without an electric law.
double largest_electric_curvature(const Material& material, const std::array<double, 9>& F,
                                  const std::array<double, 3>& E);

}  // namespace muldi::fem
