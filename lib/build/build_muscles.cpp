#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <tuple>

#include "base/error.hpp"
#include "build/build_terms.hpp"
#include "build/permittivity.hpp"
#include "build/place_bodies.hpp"
#include "muscles/element_observables.hpp"

namespace muldi::build {
namespace {

bool is_free(const scene::Muscle& muscle) { return muscle.ends == scene::MuscleEnds::free; }

double distance(const TermContext& context, const scene::Attachment& from, const scene::Attachment& to) {
  const auto at = [&](const scene::Attachment& end) {
    const int body = body_index(context.scene, end.body.name);
    const multibody::Pose pose =
        body == multibody::ground ? multibody::Pose{} : context.poses[static_cast<std::size_t>(body)];
    return pose.point(to_eigen(end.at.position));
  };
  return (at(from) - at(to)).norm();
}

double rest_length(const TermContext& context, const scene::Muscle& muscle) {
  if (muscle.rest_length) return *muscle.rest_length;
  return is_free(muscle) ? *muscle.length : distance(context, *muscle.from, *muscle.to);
}

muscles::MuscleGiven given_of(const scene::Scene& scene, const scene::Muscle& muscle, double length) {
  const scene::Material& material = scene.materials.find(muscle.material.name)->value;
  const auto& elastic = std::get<scene::NeoHookean>(material.elastic.law);
  return {.section = muscle.section,
          .length = length,
          .layer_thickness = muscle.layer_thickness,
          .density = material.density,
          .shear_modulus = elastic.shear_modulus(),
          .poisson_ratio = elastic.poisson_ratio(),
          .viscosity = material.viscous ? std::get<scene::KelvinVoigt>(material.viscous->law).viscosity : 0.0,
          .electric_law = electric_law(material, scene.units.eps0()),
          .eps0 = scene.units.eps0(),
          .isolated = is_free(muscle)};
}

/// Where the element of a model takes its control from.
template <class Model>
auto inputs_of(const TermContext& context, const scene::Muscle& muscle, const muscles::MuscleGiven& given) {
  constexpr int n_controls = muscles::MuscleElement<Model>::n_controls;
  static_assert(n_controls <= 1, "a scene names one control a muscle");
  std::array<muscles::ControlInput, static_cast<std::size_t>(n_controls)> inputs;
  for (muscles::ControlInput& input : inputs) {
    if (!muscle.control) break;
    const scene::ControlQuantity quantity = context.scene.controls.find(muscle.control->name)->value.quantity;
    input.control = context.controls.index(muscle.control->name);
    input.factor = Model::control_factor(word_of(quantity), given);
  }
  return inputs;
}

void add_observables(TermContext& context, std::vector<model::Observable> observables) {
  for (model::Observable& observable : observables) context.built.model->observables.push_back(std::move(observable));
}

/// The term of these elements, if there are any.
template <class Term, class Components, class... Arguments>
void add_term(TermContext& context, Components components, const Arguments&... arguments) {
  if (components.empty()) return;
  context.built.model->terms.push_back(std::make_unique<Term>(std::move(components), arguments...));
}

/// The terms of all muscles of one model.
template <class Model>
void add_muscles_of(TermContext& context, std::vector<base::Diagnostic>& errors) {
  using Element = muscles::MuscleElement<Model>;
  std::vector<muscles::TwoPointComponent<Element>> attached;
  std::vector<muscles::FreeActuator<Element>> free;
  const int n_bodies = static_cast<int>(context.scene.bodies.size());
  int n_free = 0;  // of all models: each has an entry of q
  for (const auto& entry : context.scene.muscles) {
    const scene::Muscle& muscle = entry.value;
    const int free_index = is_free(muscle) ? n_free++ : -1;
    if (muscle.model != scene::muscle_model<Model>) continue;
    const double length = rest_length(context, muscle);
    if (length <= 0.0) {
      errors.push_back(scene::error_at(entry.origin, "its ends coincide in the scene pose; give its rest_length"));
      continue;
    }
    const muscles::MuscleGiven given = given_of(context.scene, muscle, length);
    const Element element = std::get<std::optional<Model>>(muscle.options).value_or(Model{}).element(given);
    const auto inputs = inputs_of<Model>(context, muscle, given);
    for (const muscles::ControlInput& input : inputs) {
      if (input.control < 0) continue;
      context.built.driven_muscles.push_back({entry.name, input.control, input.factor, length});
    }
    const auto add_records = [&](const auto& component) {
      add_observables(context, muscles::observables_of(component));
      const model::ElectricRecord wanted = electric_record(context.scene);
      if (muscle.control && wanted.any()) muscles::add_electric(component, wanted, *context.built.model);
    };
    if (is_free(muscle)) {
      free.push_back({entry.name, element, n_bodies + free_index, 12 * n_bodies + free_index, inputs});
      add_records(free.back());
    } else {
      attached.push_back(
          {entry.name, element, point_of(context.scene, *muscle.from), point_of(context.scene, *muscle.to), inputs});
      add_records(attached.back());
    }
    context.built.assembled.damping |= element.dissipates();
    context.built.assembled.electric |= muscle.control.has_value();
  }
  context.built.assembled.muscles += attached.size();
  context.built.assembled.free_actuators += free.size();
  add_term<muscles::TwoPointTerm<Element>>(context, std::move(attached), to_eigen(context.scene.gravity));
  add_term<muscles::FreeActuatorTerm<Element>>(context, std::move(free));
}

/// The term of all springs of one type.
template <class Type>
void add_springs_of(TermContext& context) {
  using Element = muscles::SpringElement<Type>;
  static_assert(Element::n_controls == 0, "springs have no controls");
  std::vector<muscles::TwoPointComponent<Element>> springs;
  for (const auto& entry : context.scene.springs) {
    const scene::Spring& spring = entry.value;
    const Type* said = std::get_if<Type>(&spring.type);
    if (said == nullptr) continue;
    springs.push_back({entry.name,
                       said->element(distance(context, spring.from, spring.to)),
                       point_of(context.scene, spring.from),
                       point_of(context.scene, spring.to),
                       {}});
    add_observables(context, muscles::observables_of(springs.back()));
    context.built.assembled.damping |= springs.back().element.dissipates();
  }
  add_term<muscles::TwoPointTerm<Element>>(context, std::move(springs), to_eigen(context.scene.gravity));
}

}  // namespace

std::vector<double> free_lengths(const scene::Scene& scene) {
  std::vector<double> lengths;
  for (const auto& entry : scene.muscles) {
    if (entry.value.ends == scene::MuscleEnds::free) lengths.push_back(*entry.value.length);
  }
  return lengths;
}

model::LinearPoint point_of(const scene::Scene& scene, const scene::Attachment& end) {
  return multibody::body_point(body_index(scene, end.body.name), to_eigen(end.at.position));
}

model::ElectricRecord electric_record(const scene::Scene& scene) {
  model::ElectricRecord wanted;
  for (const scene::ElectricQuantity quantity : scene.record.electric) {
    wanted.capacitance |= quantity == scene::ElectricQuantity::capacitance;
    wanted.stored_energy |= quantity == scene::ElectricQuantity::stored_energy;
    wanted.supplied_energy |= quantity == scene::ElectricQuantity::supplied_energy;
  }
  return wanted;
}

void add_muscles(TermContext& context) {
  std::vector<base::Diagnostic> errors;
  base::for_each_type(muscles::MuscleModels{},
                      [&]<class Model>(std::type_identity<Model>) { add_muscles_of<Model>(context, errors); });
  if (!errors.empty()) throw base::InputError(std::move(errors));
}

void add_springs(TermContext& context) {
  base::for_each_type(muscles::SpringTypes{},
                      [&]<class Type>(std::type_identity<Type>) { add_springs_of<Type>(context); });
  context.built.assembled.springs = context.scene.springs.size();
}

}  // namespace muldi::build
