// Muscles, springs, loads, the initial state and the tasks.
#include <cmath>

#include "base/text.hpp"
#include "scene/scene_check.hpp"

namespace muldi::scene {
namespace {

/// Whether a described type has required fields.
struct NeedsInput {
  bool any = false;

  template <class Value>
  void operator()(const base::Field& field, const Value&) {
    any = any || field.need == base::Need::required;
  }
  template <class Value>
  void operator()(const base::Choice& choice, const Value&) {
    any = any || choice.need == base::Need::required;
  }
  void operator()(const base::Later&) const {}
};

std::vector<ControlQuantity> quantities_of(std::span<const std::string_view> known) {
  std::vector<ControlQuantity> quantities;
  for (const std::string_view wanted : known) {
    for (const auto& word : words(ControlQuantity{})) {
      if (word.word == wanted) quantities.push_back(word.value);
    }
  }
  return quantities;
}

}  // namespace

void SceneCheck::check_muscle_ends(const Entry<Muscle>& entry) {
  const std::string_view name = entry.name;
  const Muscle& muscle = entry.value;
  const bool attached = muscle.ends == MuscleEnds::attached;
  const auto need = [&](bool given, bool wanted, std::string_view key) {
    if (given == wanted || failed({"muscles", name, key})) return;
    if (given) {
      error({"muscles", name, key},
            attached ? "belongs to a muscle with 'ends: free'" : "a muscle with 'ends: free' has none");
    } else {
      error({"muscles", name},
            "missing key '" + std::string(key) + "'" + (attached ? "" : " of a muscle with 'ends: free'"));
    }
  };
  need(muscle.from.has_value(), attached, "from");
  need(muscle.to.has_value(), attached, "to");
  need(muscle.axis.has_value(), !attached, "axis");
  need(muscle.length.has_value(), !attached, "length");
  if (muscle.axis) check_direction({"muscles", name, "axis"}, *muscle.axis);
  if (muscle.from && muscle.to) check_two_ends("muscles", name, *muscle.from, *muscle.to);
}

template <class Model>
void SceneCheck::check_muscle_control(const Entry<Muscle>& entry, const Model& model) {
  const std::string_view name = entry.name;
  const Muscle& muscle = entry.value;
  const Entry<Material>* material = scene_.materials.find(muscle.material.name);
  if (material == nullptr || failed({"materials", material->name}) || failed({"muscles", name, Model::name})) return;
  const bool dielectric = material->value.electric.has_value();
  const bool driven = model.is_driven(dielectric);
  if (muscle.control && !driven) {
    const std::string why = dielectric ? "model '" + std::string(Model::name) + "' has no control"
                                       : "material '" + material->name + "' has no electric law";
    context_.add(error_at(muscle.control->origin, why + ": a control cannot act on this muscle"));
  }
  if (!muscle.control && driven && !failed({"muscles", name, "control"})) {
    error({"muscles", name}, "missing key 'control'" +
                                 (dielectric ? ": material '" + material->name + "' is a dielectric" : std::string()));
  }
  if (!muscle.control) return;
  check_quantity(*muscle.control, quantities_of(Model::quantities));
  const Entry<Control>* control = scene_.controls.find(muscle.control->name);
  if (control != nullptr && control->value.quantity == ControlQuantity::layer_voltage && !muscle.layer_thickness &&
      !failed({"controls", control->name}) && !failed({"muscles", name, "layer_thickness"})) {
    error({"muscles", name}, "missing key 'layer_thickness': control '" + control->name + "' is a layer_voltage");
  }
}

template <class Model>
void SceneCheck::check_muscle_model(Entry<Muscle>& entry) {
  std::optional<Model>& options = std::get<std::optional<Model>>(entry.value.options);
  if (!options) {
    NeedsInput needs;
    Model::describe(options.emplace(), needs);
    if (needs.any) {
      error({"muscles", entry.name}, "missing key '" + std::string(Model::name) + "': options of the model");
      return;
    }
  }
  if (const std::optional<muscles::Fault> fault = options->fault()) {
    error({"muscles", entry.name, Model::name, fault->key}, std::string(fault->message));
  }
  check_muscle_control(entry, *options);
  const Entry<Material>* material = scene_.materials.find(entry.value.material.name);
  if (material == nullptr || failed({"materials", material->name, "elastic"})) return;
  if (!std::holds_alternative<NeoHookean>(material->value.elastic.law)) {
    error({"muscles", entry.name, "material"}, "model '" + std::string(Model::name) +
                                                   "' needs a material with elastic model neo_hookean, not '" +
                                                   material->name + "'");
  }
}

void SceneCheck::muscles() {
  for (Entry<Muscle>& entry : scene_.muscles) {
    if (failed({"muscles", entry.name, "model"})) continue;
    check_muscle_ends(entry);
    base::for_each_type(muscles::MuscleModels{}, [&]<class Model>(std::type_identity<Model>) {
      if (entry.value.model == muscle_model<Model>) check_muscle_model<Model>(entry);
    });
  }
}

void SceneCheck::springs() {
  for (const Entry<Spring>& spring : scene_.springs) {
    check_two_ends("springs", spring.name, spring.value.from, spring.value.to);
  }
}

void SceneCheck::check_load(const Entry<Load>& entry) {
  const std::string_view name = entry.name;
  const Load& load = entry.value;
  if (load.body.name == ground) context_.add(error_at(load.body.origin, "a load on the ground moves nothing"));
  if (failed({"loads", name})) return;
  if (load.force.has_value() == load.torque.has_value()) {
    error({"loads", name}, load.force ? "give either force or torque, not both" : "missing key 'force' or 'torque'");
    return;
  }
  check_direction({"loads", name, load.force ? "force" : "torque"}, load.force ? *load.force : *load.torque);
  if (load.force && !load.at) error({"loads", name}, "missing key 'at': where the force acts");
  if (load.torque && load.at) error({"loads", name, "at"}, "a torque turns the whole body: leave out 'at'");
  if (load.control.has_value() == load.magnitude.has_value()) {
    error({"loads", name},
          load.control ? "give either control or magnitude, not both" : "missing key 'control' or 'magnitude'");
  } else if (load.control) {
    check_quantity(*load.control, {load.force ? ControlQuantity::force : ControlQuantity::torque});
  }
}

void SceneCheck::loads() {
  for (const Entry<Load>& load : scene_.loads) check_load(load);
}

void SceneCheck::initial() {
  for (const Entry<JointMomentum>& momentum : scene_.initial.momentum) {
    const Entry<JointState>* state = scene_.initial.joints.find(momentum.name);
    if (state == nullptr || state->value.velocity.empty()) continue;
    error({"initial", "momentum", momentum.name},
          "joint '" + momentum.name + "' has an initial velocity already; give one");
  }
}

void SceneCheck::check_explicit() {
  const auto refuse = [&](const std::string& why) { error({"dynamics", "integrator"}, why + ": take midpoint"); };
  const std::string alone = "the explicit integrator moves solids alone, but the scene has ";
  if (!scene_.bodies.empty()) refuse(alone + "bodies");
  if (!scene_.muscles.empty()) refuse(alone + "muscles");
  if (scene_.solids.empty()) refuse("the explicit integrator moves solids, of which the scene has none");
  for (const Entry<Solid>& solid : scene_.solids) {
    if (!solid.value.attach.empty()) refuse(alone + "attachments of solid " + base::in_quotes(solid.name));
    for (const MaterialName& name : solid.value.material.names()) {
      const Entry<Material>* material = scene_.materials.find(name.name);
      if (material == nullptr || context_.failed("materials." + name.name)) continue;
      if (material->value.viscous) {
        refuse("the explicit integrator has no damping, but material " + base::in_quotes(name.name) + " is viscous");
      }
      if (formulation_of(solid.value, material->value) != Formulation::displacement) {
        refuse("the explicit integrator goes with `formulation: displacement`, which solid " +
               base::in_quotes(solid.name) + " does not have");
      }
    }
  }
}

void SceneCheck::tasks() {
  if (scene_.statics && !failed({"statics"})) {
    const Statics& statics = *scene_.statics;
    if (statics.control && !statics.to) error({"statics"}, "missing key 'to': the last value of the control");
    if (!statics.control && statics.to) error({"statics", "to"}, "needs a control");
    if (!statics.control && statics.from != 0.0) error({"statics", "from"}, "needs a control");
    if (!statics.control && statics.continuation == Continuation::arc_length) {
      error({"statics", "continuation"}, "arc_length needs a control");
    }
  }
  for (const RecordedPoint& recorded : scene_.record.points) {
    if (recorded.body.name != ground) continue;
    context_.add(error_at(recorded.body.origin, "the ground does not move: nothing to record"));
  }
  if (!scene_.dynamics || failed({"dynamics"})) return;
  if (scene_.dynamics->integrator == Integrator::explicit_scheme) check_explicit();
  const Dynamics& dynamics = *scene_.dynamics;
  const double steps = dynamics.duration / dynamics.step;
  const double most_steps = 2e9;
  if (steps > most_steps) {
    error({"dynamics", "step"}, "gives " + base::number_text(steps, 3) + " steps, at most 2e9 are run");
    return;
  }
  // Both numbers are rounded once where they are written, so their quotient is off by a few units in the last place.
  if (std::abs(steps - std::round(steps)) <= 1e-9 * steps && steps > 0.5) return;
  const std::string unit = " " + scene_.units.time();
  const double below = std::floor(steps) * dynamics.step;
  const double above = std::ceil(steps) * dynamics.step;
  error({"dynamics", "duration"},
        "is no multiple of the step " + base::number_text(dynamics.step, 12) + unit + ": take " +
            (below > 0.0 ? base::number_text(below, 12) + unit + " or " : std::string()) +
            base::number_text(above, 12) + unit + ", got " + base::number_text(dynamics.duration, 12) + unit);
}

}  // namespace muldi::scene
