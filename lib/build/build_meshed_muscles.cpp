/// Muscles of finite elements: a bar of layers with electrodes between two end faces.
#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/text.hpp"
#include "build/build_solids.hpp"
#include "build/build_ties.hpp"
#include "build/meshed_muscle_observables.hpp"
#include "build/place_bodies.hpp"
#include "fem/mesh/generate.hpp"

namespace muldi::build {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// An axis of a body serves as that of a section if it is 45 degrees off the muscle or more, but for round-off.
constexpr double largest_cosine = 0.70710678118654752 * (1.0 + 1e-9);
/// A rest length may miss the distance of the ends by this fraction.
constexpr double length_tolerance = 1e-6;

/// The muscle's material with what its options replace.
scene::Material replaced(scene::Material material, const muscles::Replacements& by) {
  const double nu = material.elastic.poisson_ratio();
  std::optional<double> mu = by.shear_modulus;
  if (by.young) mu = *by.young / (2.0 * (1.0 + nu));
  if (mu) {
    std::visit(
        [&](auto& law) {
          if constexpr (requires { law.young; }) {
            law.young = law.lambda = law.kappa = {};
            law.mu = mu;
            law.poisson = nu;
          }
        },
        material.elastic.law);
  }
  if (by.density) material.density = *by.density;
  if (by.viscosity) material.viscous = {.law = scene::KelvinVoigt{.viscosity = *by.viscosity}};
  if (material.viscous && std::get<scene::KelvinVoigt>(material.viscous->law).viscosity == 0.0) material.viscous = {};
  if (by.relative_permittivity) {
    if (!material.electric) material.electric.emplace();
    material.electric->law = scene::IdealDielectric{.relative_permittivity = *by.relative_permittivity};
  }
  return material;
}

/// The bar along z from the origin, before it is placed.
fem::Mesh bar(const muscles::Section& section, const scene::MeshedMuscle& options, double length) {
  if (const auto* round = std::get_if<muscles::RoundSection>(&section.shape)) {
    return fem::make_mesh(fem::Cylinder{
        .section = {.diameter = round->diameter, .section_cells = options.section_cells, .rim = options.rim},
        .length = length,
        .axis = fem::Axis::z,
        .layers = options.layers});
  }
  const double edge = std::get<muscles::SquareSection>(section.shape).edge;
  const int n = options.cells_along_edge();
  return fem::make_mesh(
      fem::Box{.size = {edge, edge, length}, .cells = {n, n, options.layers}, .centre = {0.0, 0.0, 0.5 * length}});
}

/// Columns: the first and second axis of the section, and the direction of the muscle.
std::optional<Matrix3d> frame_of(const scene::MeshedMuscle& options, const Matrix3d& body, const Vector3d& along) {
  Vector3d across = std::abs(body.col(0).dot(along)) <= largest_cosine ? body.col(0) : body.col(1);
  if (options.section_axis) across = to_eigen(*options.section_axis).normalized();
  across -= along.dot(across) * along;
  if (across.norm() < 1e-6) return {};
  Matrix3d frame;
  frame.col(0) = across.normalized();
  frame.col(1) = along.cross(frame.col(0));
  frame.col(2) = along;
  return frame;
}

class MuscleBuilder {
 public:
  MuscleBuilder(TermContext& context, const scene::Entry<scene::Muscle>& entry)
      : context_(context),
        entry_(entry),
        options_(*std::get<std::optional<scene::MeshedMuscle>>(entry.value.options)),
        material_(replaced(context.scene.materials.find(entry.value.material.name)->value, options_.replacements)),
        section_(options_.replacements.section.value_or(entry.value.section)) {}

  /// False with an error if the muscle cannot be built.
  bool build(std::vector<base::Diagnostic>& errors) {
    const multibody::Pose from = pose(*entry_.value.from);
    const Vector3d a = from.point(to_eigen(entry_.value.from->at.position));
    const Vector3d b = pose(*entry_.value.to).point(to_eigen(entry_.value.to->at.position));
    length_ = (b - a).norm();
    if (const std::string why = why_not(from, b - a); !why.empty()) {
      errors.push_back(scene::error_at(entry_.origin, why));
      return false;
    }
    require_memory(static_cast<double>(options_.layers) * options_.section_cells, entry_.origin);
    mesh_ = bar(section_, options_, length_);
    require_sound(mesh_, entry_.origin);
    place(a, *frame_of(options_, from.orientation, (b - a) / length_));
    data_.cells = mesh_.cells;
    data_.materials = {material_of(material_, context_.scene.units.eps0())};
    data_.shear_moduli = {material_.elastic.shear_modulus()};
    data_.material_of_cell.assign(mesh_.cells.size(), 0);
    data_.formulation = formulation_of(scene::formulation_of(options_.formulation, material_));
    data_.gravity = to_eigen(context_.scene.gravity);
    tie_ends();
    if (entry_.value.control) charge_layers();
    return true;
  }

  /// Gives it to the model.
  void add() {
    BuiltModel& built = context_.built;
    const fem::Solid& solid = add_solid(std::move(data_), built);
    built.solid_records.push_back(std::make_unique<fem::SolidRecords>(solid));
    const fem::SolidRecords& records = *built.solid_records.back();
    built.meshed_muscles.push_back({.index = static_cast<std::size_t>(context_.scene.muscles.index(entry_.name)),
                                    .solid = &solid,
                                    .records = &records});
    for (TiedNodes& group : ends_) {
      built.ties.push_back(std::make_unique<TiedNodes>(std::move(group)));
      add_tie_observables(entry_.name, solid, *built.ties.back(), *built.model);
    }
    const std::size_t n = built.ties.size();
    add_muscle_observables({.name = entry_.name,
                            .length = length_,
                            .from = point_of(context_.scene, *entry_.value.from),
                            .to = point_of(context_.scene, *entry_.value.to),
                            .at_from = *built.ties[n - 2],
                            .at_to = *built.ties[n - 1],
                            .records = records,
                            .layers = options_.layers,
                            .driven = std::move(driven_),
                            .input = input_,
                            .layer_thickness = entry_.value.layer_thickness,
                            .wanted = electric_record(context_.scene)},
                           *built.model);
    ++built.assembled.muscles;
    ++built.assembled.meshed_muscles;
  }

 private:
  multibody::Pose pose(const scene::Attachment& end) const {
    const int body = body_index(context_.scene, end.body.name);
    return body == multibody::ground ? multibody::Pose{} : context_.poses[static_cast<std::size_t>(body)];
  }

  std::string why_not(const multibody::Pose& from, const Vector3d& span) const {
    if (length_ == 0.0) return "its ends coincide in the scene pose: there is no room for a mesh";
    const double rest = entry_.value.rest_length.value_or(length_);
    if (std::abs(rest - length_) > length_tolerance * length_) {
      return base::format(
          "a muscle of model fe is undeformed in the scene pose: its ends are {:.9g} {} apart, but rest_length is "
          "{:.9g}; "
          "move the ends, or leave out rest_length",
          length_, context_.scene.units.length(), rest);
    }
    if (!frame_of(options_, from.orientation, span / length_)) {
      return "fe: section_axis is parallel to the muscle; take a direction across it";
    }
    return {};
  }

  void place(const Vector3d& origin, const Matrix3d& frame) {
    data_.name = entry_.name;
    data_.part = "muscles/" + entry_.name;
    data_.X.resize(3 * mesh_.n_nodes());
    for (int node = 0; node < mesh_.n_nodes(); ++node) {
      data_.X.segment<3>(3 * static_cast<Eigen::Index>(node)) =
          origin + frame * to_eigen(mesh_.nodes[static_cast<std::size_t>(node)]);
    }
  }

  std::vector<int> nodes_of_layer(int layer) const {
    std::vector<int> nodes;
    for (int node = 0; node < mesh_.n_nodes(); ++node) {
      if (mesh_.layer_of_node[static_cast<std::size_t>(node)] == layer) nodes.push_back(node);
    }
    return nodes;
  }

  void tie_ends() {
    TieBuilder ties(context_.scene, context_.poses, data_);
    for (const auto& [end, layer] :
         {std::pair(&*entry_.value.from, 0), std::pair(&*entry_.value.to, options_.layers)}) {
      const int body = body_index(context_.scene, end->body.name);
      for (const int node : nodes_of_layer(layer)) {
        ties.add(node, body);
        if (body != multibody::ground) continue;
        for (int i = 0; i < 3; ++i) data_.displacements.push_back({node, i, {}});
      }
    }
    ends_ = ties.groups();
  }

  /// Node layers at 0 and at the voltage of one layer of cells in turn.
  void charge_layers() {
    const std::string& name = entry_.value.control->name;
    const scene::ControlQuantity quantity = context_.scene.controls.find(name)->value.quantity;
    input_.control = context_.controls.index(name);
    input_.factor =
        muscles::field_factor(word_of(quantity), {.length = length_, .layer_thickness = entry_.value.layer_thickness});
    const double thickness = length_ / options_.layers;
    for (int layer = 0; layer <= options_.layers; ++layer) {
      const bool is_driven = layer % 2 == 1;
      fem::Value value;
      if (is_driven) value = {.control = input_.control, .factor = input_.factor * thickness};
      for (const int node : nodes_of_layer(layer)) {
        data_.potentials.push_back({node, value});
        if (is_driven) driven_.push_back(node);
      }
    }
  }

  TermContext& context_;
  const scene::Entry<scene::Muscle>& entry_;
  const scene::MeshedMuscle& options_;
  scene::Material material_;
  muscles::Section section_;
  double length_ = 0.0;
  fem::Mesh mesh_;
  fem::SolidDescription data_;
  std::vector<TiedNodes> ends_;
  std::vector<int> driven_;
  muscles::ControlInput input_;
};

}  // namespace

void add_meshed_muscles(TermContext& context) {
  std::vector<base::Diagnostic> errors;
  for (const auto& entry : context.scene.muscles) {
    if (!scene::is_meshed(entry.value)) continue;
    MuscleBuilder builder(context, entry);
    if (builder.build(errors)) builder.add();
  }
  if (!errors.empty()) throw base::InputError(std::move(errors));
}

}  // namespace muldi::build
