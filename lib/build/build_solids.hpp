#pragma once
/// Scene solids -> finite-element solids.
#include <memory>
#include <vector>

#include "build/build_controls.hpp"
#include "build/built_model.hpp"
#include "fem/mesh/mesh.hpp"
#include "fem/solid/solid_description.hpp"

namespace muldi::build {

/// The mesh of a solid with the nodes where they are in the scene pose. InputError for a file that is no mesh, and for
/// meshes that cannot carry a solid.
fem::Mesh mesh_of(const scene::Scene& scene, const scene::Entry<scene::Solid>& entry);

/// Laws and parameters for the kernels.
fem::Material material_of(const scene::Material& material, double eps0);

/// What the parts of a solid are built from; errors are collected.
struct SolidContext {
  const scene::Scene& scene;
  ControlTable& controls;
  std::vector<base::Diagnostic>& errors;
};

/// Prescribed values, loads, electrodes and ties to the ground.
void add_conditions(const SolidContext& context, const scene::Entry<scene::Solid>& entry, const fem::Mesh& mesh,
                    fem::SolidDescription& data);

/// Adds what the scene records of solids to the model: `meshes` and the substructures are in the order of the scene's
/// solids. InputError for probes that find nothing.
void add_solid_observables(const scene::Scene& scene, const std::vector<fem::Mesh>& meshes, BuiltModel& built);

/// Adds all solids of the scene to the model.
void add_solids(const scene::Scene& scene, ControlTable& controls, BuiltModel& built);

}  // namespace muldi::build
