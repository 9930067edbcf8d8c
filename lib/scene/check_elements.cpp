// Muscles, springs, loads, the initial state and the tasks.

#include "base/text.hpp"
#include "scene/multiples.hpp"
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
  if constexpr (std::is_same_v<Model, MeshedMuscle>) {
    check_meshed_muscle(entry, *options, material->value.elastic);
  } else if (!std::holds_alternative<NeoHookean>(material->value.elastic.law)) {
    error({"muscles", entry.name, "material"}, "model '" + std::string(Model::name) +
                                                   "' needs a material with elastic model neo_hookean, not '" +
                                                   material->name + "'");
  }
}

void SceneCheck::check_meshed_muscle(const Entry<Muscle>& entry, const MeshedMuscle& mesh, const Elastic& elastic) {
  const std::string_view name = entry.name;
  if (entry.value.ends == MuscleEnds::free) {
    error({"muscles", name, "ends"},
          "model 'fe' has both ends attached; an isolated actuator of finite elements is a solid with conditions");
  }
  if (scene_.solids.find(name) != nullptr) {
    error({"muscles", name}, "a solid has the same name: call one of them otherwise, to tell their results apart");
  }
  if (failed({"muscles", name, "fe"})) return;
  if (mesh.section_axis) check_direction({"muscles", name, "fe", "section_axis"}, *mesh.section_axis);
  const std::string why_no_mesh = mesh.why_no_mesh(entry.value.section);
  if (!why_no_mesh.empty()) error({"muscles", name, "fe", "section_cells"}, why_no_mesh);
  const Entry<Material>& material = *scene_.materials.find(entry.value.material.name);
  const std::string why_unfit =
      scene::why_unfit(formulation_of(mesh.formulation, material.value), elastic, material.name);
  if (!why_unfit.empty()) error({"muscles", name, "fe", "formulation"}, why_unfit);
  const bool two_constants =
      std::holds_alternative<NeoHookean>(elastic.law) || std::holds_alternative<BonetWood>(elastic.law);
  if (two_constants) return;
  for (const auto& [key, given] : {std::pair("young", mesh.replacements.young.has_value()),
                                   std::pair("mu", mesh.replacements.shear_modulus.has_value())}) {
    if (given) {
      error({"muscles", name, "fe", key},
            "replaces a constant of neo_hookean or bonet_wood; material '" + material.name + "' has another law");
    }
  }
}

void SceneCheck::muscles() {
  for (Entry<Muscle>& entry : scene_.muscles) {
    if (failed({"muscles", entry.name, "model"})) continue;
    check_muscle_ends(entry);
    base::for_each_type(MuscleModels{}, [&]<class Model>(std::type_identity<Model>) {
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
      if (formulation_of(solid.value.formulation, material->value) != Formulation::displacement) {
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
  std::string why = why_no_multiple(dynamics.duration, dynamics.step, "the step", scene_.units.time());
  if (!why.empty()) error({"dynamics", "duration"}, std::move(why));
}

}  // namespace muldi::scene
