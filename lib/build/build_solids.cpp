#include "build/build_solids.hpp"

#include <optional>

#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/text.hpp"
#include "build/build_ties.hpp"
#include "build/join_solids.hpp"
#include "build/place_bodies.hpp"
#include "fem/mesh/check_mesh.hpp"
#include "fem/mesh/generate.hpp"
#include "fem/solid/solid.hpp"

namespace muldi::build {
namespace {

using base::Diagnostic;

fem::Material elastic_laws(const scene::Elastic& elastic) {
  fem::Material material;
  material.elastic = std::visit(
      [](const auto& law) -> base::VariantOf<fem::ElasticLaws> {
        using Law = std::decay_t<decltype(law)>;
        if constexpr (std::is_same_v<Law, scene::NeoHookean>) {
          return fem::NeoHookean{.mu = law.shear_modulus()};
        } else if constexpr (std::is_same_v<Law, scene::BonetWood>) {
          const double nu = law.poisson_ratio();
          return fem::BonetWood{.mu = law.shear_modulus(), .lambda = 2.0 * law.shear_modulus() * nu / (1.0 - 2.0 * nu)};
        } else if constexpr (std::is_same_v<Law, scene::MooneyRivlin>) {
          return fem::MooneyRivlin{.mu_1 = law.mu_1, .mu_2 = law.mu_2};
        } else {
          return fem::Gent{.mu = law.mu, .J_m = law.locking};
        }
      },
      elastic.law);
  if (elastic.incompressible()) return material;
  const double kappa = elastic.bulk_modulus();
  std::visit(
      [&](const auto& law) {
        if constexpr (requires { law.volumetric; }) {
          if (law.volumetric == scene::Volumetric::quadratic) {
            fem::Quadratic u;
            u.kappa = kappa;
            material.volumetric = u;
          } else {
            fem::Logarithmic u;
            u.kappa = kappa;
            material.volumetric = u;
          }
        }
      },
      elastic.law);
  return material;
}

void place_nodes(const scene::Solid& solid, const fem::Mesh& mesh, Eigen::VectorXd& X) {
  Eigen::Matrix3d R;
  for (int row = 0; row < 3; ++row) R.row(row) = to_eigen(solid.orientation.matrix[static_cast<std::size_t>(row)]);
  const Eigen::Vector3d origin = to_eigen(solid.position);
  X.resize(3 * mesh.n_nodes());
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    X.segment<3>(3 * static_cast<Eigen::Index>(node)) =
        origin + R * to_eigen(mesh.nodes[static_cast<std::size_t>(node)]);
  }
}

/// Materials of the cells, each law once.
void add_materials(const scene::Scene& scene, const scene::Entry<scene::Solid>& entry, const fem::Mesh& mesh,
                   std::vector<Diagnostic>& errors, fem::SolidDescription& data) {
  const scene::SolidMaterial& said = entry.value.material;
  std::vector<int> material_of_part(mesh.parts.size(), said.whole.name.empty() ? -1 : 0);
  for (const scene::MaterialName& name : said.names()) {
    const scene::Material& material = scene.materials.find(name.name)->value;
    data.materials.push_back(material_of(material, scene.units.eps0()));
    data.shear_moduli.push_back(material.elastic.shear_modulus());
  }
  for (std::size_t i = 0; i < said.parts.size(); ++i) {
    const int part = mesh.find_part(said.parts[i].name);
    if (part >= 0) {
      material_of_part[static_cast<std::size_t>(part)] = static_cast<int>(i);
    } else {
      errors.push_back(scene::error_at(said.parts[i].origin, "the mesh has no part '" + said.parts[i].name + "'" +
                                                                 base::did_you_mean(said.parts[i].name, mesh.parts)));
    }
  }
  for (std::size_t part = 0; part < mesh.parts.size(); ++part) {
    if (material_of_part[part] < 0) {
      errors.push_back(scene::error_at(said.origin, "no material for part '" + mesh.parts[part] + "' of the mesh"));
    }
  }
  for (const int part : mesh.part_of_cell) {
    data.material_of_cell.push_back(material_of_part[static_cast<std::size_t>(part)]);
  }
}

fem::Formulation formulation(const scene::Scene& scene, const scene::Entry<scene::Solid>& entry,
                             std::vector<Diagnostic>& errors) {
  std::optional<scene::Formulation> common;
  for (const scene::MaterialName& name : entry.value.material.names()) {
    const scene::Formulation one =
        scene::formulation_of(entry.value.formulation, scene.materials.find(name.name)->value);
    if (common && *common != one) {
      errors.push_back(scene::error_at(
          entry.origin,
          "its materials ask for different formulations (one is incompressible); give the solid's formulation"));
    }
    common = one;
  }
  return formulation_of(*common);
}

/// Bytes that a cell and its share of the nodes take at least, in states, tables and one sparse matrix.
constexpr double bytes_of_cell = 4000.0;

/// Cells that the mesh will have; 0 where only its file knows.
double expected_cells(const fem::MeshType& mesh) {
  return std::visit(
      [](const auto& said) {
        if constexpr (requires { said.n_cells(); }) {
          return static_cast<double>(said.n_cells());
        } else {
          return 0.0;
        }
      },
      mesh);
}

fem::Mesh mesh_of(const scene::Scene& scene, const scene::Entry<scene::Solid>& entry) {
  return std::visit(
      [&](const auto& said) {
        if constexpr (requires { said.path; }) {
          return fem::make_mesh({.path = scene::path_of_file(scene, said.path), .scale = said.scale}, "");
        } else {
          return fem::make_mesh(said);
        }
      },
      entry.value.mesh);
}

fem::SolidDescription describe_solid(const SolidContext& context, const scene::Entry<scene::Solid>& entry,
                                     const fem::Mesh& mesh) {
  fem::SolidDescription data{.name = entry.name};
  place_nodes(entry.value, mesh, data.X);
  data.cells = mesh.cells;
  data.formulation = formulation(context.scene, entry, context.errors);
  data.gravity = to_eigen(context.scene.gravity);
  data.labels_of_nodes = mesh.labels_of_nodes;
  data.labels_of_cells = mesh.labels_of_cells;
  add_materials(context.scene, entry, mesh, context.errors, data);
  return data;
}

/// Gives what was joined to the model, with the forces of its ties.
void add_joined(TermContext& terms, JoinedSolid joined) {
  BuiltModel& built = terms.built;
  const fem::Solid& solid = add_solid(std::move(joined.data), built);
  const auto& entry = terms.scene.solids[joined.solids.front()];
  if (std::string note = solid.note(); !note.empty()) {
    built.notes.push_back(scene::warning_at(entry.origin, std::move(note)));
  }
  for (std::size_t member = 0; member < joined.solids.size(); ++member) {
    const auto& own = terms.scene.solids[joined.solids[member]];
    built.solid_records[joined.solids[member]] = std::make_unique<fem::SolidRecords>(solid, member);
    for (TiedNodes& group : joined.tied[member]) {
      if (const std::string note = freedom_note(solid.data().X, group); !note.empty()) {
        built.notes.push_back(scene::warning_at(own.origin, "solid '" + own.name + "' " + note));
      }
      built.ties.push_back(std::make_unique<TiedNodes>(std::move(group)));
      add_tie_observables(own.name, solid, *built.ties.back(), *built.model);
    }
  }
  built.notes.insert(built.notes.end(), joined.notes.begin(), joined.notes.end());
  for (JoinedNodes& joint : joined.joints) add_joint_observables(solid, std::move(joint), *built.model);
}

}  // namespace

fem::Material material_of(const scene::Material& said, double eps0) {
  fem::Material material = elastic_laws(said.elastic);
  material.density = said.density;
  if (said.electric) {
    material.electric = std::visit(
        [eps0](const auto& law) -> base::VariantOf<fem::ElectricLaws> {
          if constexpr (requires { law.relative_permittivity; }) {
            return fem::IdealDielectric{.permittivity = eps0 * law.relative_permittivity};
          } else if constexpr (requires { law.c3; }) {
            return fem::Invariants{.c1 = law.c1, .c2 = law.c2, .c3 = law.c3, .eps0 = eps0};
          } else {
            return fem::Vu{.c1 = law.c1, .c2 = law.c2, .eps0 = eps0};
          }
        },
        said.electric->law);
  }
  if (said.viscous) {
    material.viscous = fem::KelvinVoigt{.viscosity = std::get<scene::KelvinVoigt>(said.viscous->law).viscosity};
  }
  return material;
}

fem::Formulation formulation_of(scene::Formulation said) {
  switch (said) {
    case scene::Formulation::displacement:
      return fem::Formulation::displacement;
    case scene::Formulation::mean_dilatation:
      return fem::Formulation::mean_dilatation;
    case scene::Formulation::incompressible:
      return fem::Formulation::incompressible;
    case scene::Formulation::incompressible_direct:
      break;
  }
  return fem::Formulation::incompressible_direct;
}

void require_memory(double n_cells, const scene::Origin& origin) {
  try {
    base::require_memory(bytes_of_cell * n_cells, base::format("a mesh of {} cells", n_cells), "take fewer cells");
  } catch (const base::InputError& error) {
    throw base::InputError({scene::error_at(origin, error.diagnostics().front().message)});
  }
}

void require_sound(const fem::Mesh& mesh, const scene::Origin& origin) {
  std::vector<Diagnostic> errors;
  for (const std::string& sentence : fem::check_mesh(mesh).errors) errors.push_back(scene::error_at(origin, sentence));
  if (!errors.empty()) throw base::InputError(std::move(errors));
  require_memory(mesh.n_cells(), origin);
}

const fem::Solid& add_solid(fem::SolidDescription data, BuiltModel& built) {
  auto solid = std::make_unique<fem::Solid>(std::move(data));
  built.solids.push_back(solid.get());
  built.assembled.damping |= solid->is_viscous();
  built.assembled.electric |= solid->unknowns().has_field();
  built.model->substructures.push_back(std::move(solid));
  return *built.solids.back();
}

void add_solids(TermContext& terms) {
  const scene::Scene& scene = terms.scene;
  std::vector<Diagnostic> errors;
  std::vector<fem::Mesh> meshes;
  meshes.reserve(scene.solids.size());
  std::vector<SolidPart> parts;
  const SolidContext context{scene, terms.poses, terms.controls, errors};
  for (const auto& entry : scene.solids) {
    require_memory(expected_cells(entry.value.mesh), entry.origin);
    const fem::Mesh& mesh = meshes.emplace_back(mesh_of(scene, entry));
    require_sound(mesh, entry.origin);
    SolidPart& part =
        parts.emplace_back(SolidPart{.entry = &entry, .mesh = &mesh, .data = describe_solid(context, entry, mesh)});
    part.tied = add_conditions(context, entry, mesh, part.data);
  }
  if (!errors.empty()) throw base::InputError(std::move(errors));
  std::vector<JoinedSolid> joined = join_solids(std::move(parts), errors);
  if (!errors.empty()) throw base::InputError(std::move(errors));
  terms.built.solid_records.resize(scene.solids.size());
  for (JoinedSolid& one : joined) add_joined(terms, std::move(one));
  add_solid_observables(scene, meshes, terms.built);
}

}  // namespace muldi::build
