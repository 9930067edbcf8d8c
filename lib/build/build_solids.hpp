#pragma once
/// Scene solids -> finite-element solids.
#include <memory>
#include <vector>

#include "build/build_terms.hpp"
#include "fem/mesh/mesh.hpp"
#include "fem/solid/solid_description.hpp"

namespace muldi::build {

/// InputError at `origin` for a mesh that cannot carry a solid, or that does not fit into memory.
void require_sound(const fem::Mesh& mesh, const scene::Origin& origin);
void require_memory(double n_cells, const scene::Origin& origin);

/// Laws and parameters for the kernels.
fem::Material material_of(const scene::Material& material, double eps0);
fem::Formulation formulation_of(scene::Formulation said);

/// What the parts of a solid are built from; errors are collected.
struct SolidContext {
  const scene::Scene& scene;
  const std::vector<multibody::Pose>& poses;
  ControlTable& controls;
  std::vector<base::Diagnostic>& errors;
};

/// Prescribed values, loads, electrodes and ties; returns what was tied to what.
std::vector<TiedNodes> add_conditions(const SolidContext& context, const scene::Entry<scene::Solid>& entry,
                                      const fem::Mesh& mesh, fem::SolidDescription& data);

/// Gives a solid to the model.
const fem::Solid& add_solid(fem::SolidDescription data, BuiltModel& built);

/// Adds what the scene records of solids to the model: `meshes` and the records of solids are in the order of the
/// scene's solids. InputError for probes that find nothing.
void add_solid_observables(const scene::Scene& scene, const std::vector<fem::Mesh>& meshes, BuiltModel& built);
/// Adds the fields that the scene records of solids and meshed muscles, the last to be added to the model.
void add_field_histories(const scene::Scene& scene, BuiltModel& built);

/// Adds all solids of the scene to the model.
void add_solids(TermContext& context);

/// Adds all muscles of model fe, after the solids.
void add_meshed_muscles(TermContext& context);

}  // namespace muldi::build
