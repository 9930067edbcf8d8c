#pragma once
/// Electric laws of materials as muscles use them.
#include "muscles/electric_law.hpp"
#include "scene/scene.hpp"

namespace muldi::build {

/// The enthalpy of a material along its axis of stretch; `eps0` in the units of the scene. Zero where it is no
/// dielectric.
muscles::ElectricLaw electric_law(const scene::Material& material, double eps0);

/// Relative permittivities of a material at a stretch: by the force between electrodes and by their capacitance (thesis
/// 7.36, 7.37).
double force_permittivity(const scene::Scene& scene, const scene::Material& material, double stretch);
double capacity_permittivity(const scene::Scene& scene, const scene::Material& material, double stretch);

}  // namespace muldi::build
