/// Guards of the dielectrics: the field in the deformed material against its strength (numerics 4.5).
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "base/text.hpp"
#include "build/build_terms.hpp"
#include "build/place_bodies.hpp"
#include "fem/solid/field_peaks.hpp"
#include "fem/solid/solid_observables.hpp"

namespace muldi::build {
namespace {

/// The strength of a material, and how messages call it.
struct Strength {
  double field = 0.0;
  std::string material = {};
  std::string unit = {};

  std::string sentence(const std::string& place, double reached) const {
    return base::format(
        "{} reaches a field of {:.6g} {} in its deformed material, beyond the breakdown_field of '{}', {:.6g} {}",
        place, reached, unit, material, field, unit);
  }
};

std::optional<Strength> strength_of(const scene::Scene& scene, const std::string& material) {
  const scene::Material& said = scene.materials.find(material)->value;
  if (!said.electric || !said.electric->breakdown_field) return {};
  return Strength{.field = *said.electric->breakdown_field,
                  .material = material,
                  .unit = scene.units.unit_name(base::dimension::field)};
}

/// By what is recorded of the muscle, so that the record shows what is compared.
void guard_muscle(const scene::Entry<scene::Muscle>& entry, const Strength& strength, model::Model& model) {
  const std::string path = "muscles/" + entry.name + "/true_field";
  for (const model::Observable& observable : model.observables) {
    if (observable.path != path) continue;
    model.guards.push_back({.breach = [place = "muscle '" + entry.name + "'", strength,
                                       evaluate = observable.evaluate](const model::NodeView& at) -> std::string {
      double field = 0.0;
      evaluate(at, {&field, 1});
      if (std::abs(field) <= strength.field) return {};
      return strength.sentence(place, std::abs(field));
    }});
    return;
  }
}

/// Looks at every Gauss point of the cells whose material has a strength.
class SolidGuard {
 public:
  SolidGuard(std::string name, const fem::SolidRecords& records, std::vector<std::optional<Strength>> strengths)
      : name_(std::move(name)),
        records_(records),
        strengths_(std::move(strengths)),
        peaks_(records.solid().elements().n_cells()) {}

  std::string breach(const model::NodeView& at) {
    const fem::Solid& solid = records_.solid();
    fem::field_peaks(solid.elements(), solid.positions(at.q), records_.potentials(at), peaks_);
    const std::vector<int>& materials = solid.elements().material_of_cell();
    const Strength* passed = nullptr;
    Eigen::Index worst = 0;
    double most = 1.0;
    const fem::Member& member = records_.member();
    for (Eigen::Index cell = member.first_cell; cell < member.first_cell + member.n_cells; ++cell) {
      const int material = materials[static_cast<std::size_t>(cell)] - member.first_material;
      const auto& strength = strengths_[static_cast<std::size_t>(material)];
      if (!strength || peaks_[cell] <= most * strength->field) continue;
      most = peaks_[cell] / strength->field;
      worst = cell;
      passed = &*strength;
    }
    if (passed == nullptr) return {};
    return passed->sentence(solid.place_of_cell(static_cast<int>(worst)) + " of " + name_, peaks_[worst]);
  }

 private:
  std::string name_;
  const fem::SolidRecords& records_;
  std::vector<std::optional<Strength>> strengths_;  // of the materials of the solid
  Eigen::VectorXd peaks_;
};

void guard_solid(SolidGuard guard, model::Model& model) {
  model.guards.push_back({.breach = [shared = std::make_shared<SolidGuard>(std::move(guard))](
                                        const model::NodeView& at) { return shared->breach(at); }});
}

/// Times at which a run looks at its controls, or enough of them.
std::vector<double> looks_at_controls(const scene::Scene& scene) {
  constexpr long most = 2000;
  if (!scene.dynamics) return {0.0};
  const long steps = scene.dynamics->n_steps();
  std::vector<double> times;
  for (long i = 0; i < std::min(steps, most); ++i) {
    const long step = steps <= most ? i : i * (steps / most);
    times.push_back((static_cast<double>(step) + 0.5) * scene.dynamics->step);
  }
  return times;
}

}  // namespace

void note_strong_fields(const scene::Scene& scene, BuiltModel& built) {
  if (built.model->guards.empty() || !(scene.dynamics || scene.statics)) return;
  const std::vector<double> times = looks_at_controls(scene);
  std::vector<double> u(built.model->controls.size());
  for (const DrivenMuscle& muscle : built.driven_muscles) {
    const auto& entry = *scene.muscles.find(muscle.name);
    const auto strength = strength_of(scene, entry.value.material.name);
    if (!strength) continue;
    for (const double t : times) {
      built.model->evaluate_controls(t, u);
      const double field = std::abs(muscle.field_factor * u[static_cast<std::size_t>(muscle.control)]);
      if (field <= strength->field) continue;
      const std::string sentence = base::format(
          "its control '{}' gives a field of {:.6g} {} in the undeformed muscle, beyond the breakdown_field of '{}', "
          "{:.6g} {}: the run ends there with `breakdown` unless the muscle is stretched",
          entry.value.control->name, field, strength->unit, strength->material, strength->field, strength->unit);
      built.notes.push_back(scene::warning_at(entry.origin, sentence));
      break;
    }
  }
}

void add_guards(TermContext& context) {
  const scene::Scene& scene = context.scene;
  BuiltModel& built = context.built;
  for (const auto& entry : scene.muscles) {
    if (scene::is_meshed(entry.value) || !entry.value.control) continue;
    if (auto strength = strength_of(scene, entry.value.material.name)) guard_muscle(entry, *strength, *built.model);
  }
  for (std::size_t i = 0; i < scene.solids.size(); ++i) {
    if (!built.solid_records[i]->solid().unknowns().has_field()) continue;
    std::vector<std::optional<Strength>> strengths;
    bool any = false;
    for (const scene::MaterialName& name : scene.solids[i].value.material.names()) {
      strengths.push_back(strength_of(scene, name.name));
      any |= strengths.back().has_value();
    }
    if (any) {
      guard_solid({"solid '" + scene.solids[i].name + "'", *built.solid_records[i], std::move(strengths)},
                  *built.model);
    }
  }
  for (const MeshedMuscle& muscle : built.meshed_muscles) {
    const auto& entry = scene.muscles[muscle.index];
    const auto strength = strength_of(scene, entry.value.material.name);
    if (!strength || !muscle.solid->unknowns().has_field()) continue;
    guard_solid({"muscle '" + entry.name + "'", *muscle.records, {strength}}, *built.model);
  }
}

}  // namespace muldi::build
