#pragma once
/// The material laws that scenes may name; the kernels' tables, the tests and the readers follow these lists.
#include "base/describe.hpp"
#include "fem/materials/bonet_wood.hpp"
#include "fem/materials/gent.hpp"
#include "fem/materials/ideal_dielectric.hpp"
#include "fem/materials/invariants.hpp"
#include "fem/materials/kelvin_voigt.hpp"
#include "fem/materials/logarithmic.hpp"
#include "fem/materials/mooney_rivlin.hpp"
#include "fem/materials/neo_hookean.hpp"
#include "fem/materials/quadratic.hpp"
#include "fem/materials/vu.hpp"

namespace muldi::fem {

using ElasticLaws = base::TypeList<NeoHookean, BonetWood, MooneyRivlin, Gent>;
using VolumetricLaws = base::TypeList<Quadratic, Logarithmic>;
using ElectricLaws = base::TypeList<IdealDielectric, Vu, Invariants>;
using ViscousLaws = base::TypeList<KelvinVoigt>;

}  // namespace muldi::fem
