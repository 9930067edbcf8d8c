#include <cmath>

#include "base/error.hpp"
#include "build/build_terms.hpp"
#include "build/place_bodies.hpp"
#include "muscles/muscle_observables.hpp"

namespace muldi::build {
namespace {

double distance(const TermContext& context, const scene::Attachment& from, const scene::Attachment& to) {
  const auto at = [&](const scene::Attachment& end) {
    const int body = body_index(context.scene, end.body.name);
    const multibody::Pose pose =
        body == multibody::ground ? multibody::Pose{} : context.poses[static_cast<std::size_t>(body)];
    return pose.point(to_eigen(end.at.position));
  };
  return (at(from) - at(to)).norm();
}

muscles::ElectricLaw electric_law(const scene::Material& material, double eps0) {
  if (!material.electric) return {};
  if (const auto* ideal = std::get_if<scene::IdealDielectric>(&material.electric->law)) {
    return muscles::ElectricLaw::ideal(ideal->relative_permittivity, eps0);
  }
  const auto& law = std::get<scene::Invariants>(material.electric->law);
  return muscles::ElectricLaw::invariants(law.c1, law.c2, law.c3, eps0);
}

muscles::LumpedDea element_of(const scene::Scene& scene, const scene::Muscle& muscle, double length) {
  const scene::Material material = scene::lumped_material(muscle, scene.materials.find(muscle.material.name)->value);
  const auto& section = scene::lumped_section(muscle);
  muscles::LumpedDea element;
  element.shear_modulus = std::get<scene::NeoHookean>(material.elastic.law).shear_modulus();
  element.viscosity = material.viscous ? std::get<scene::KelvinVoigt>(material.viscous->law).viscosity : 0.0;
  element.density = material.density;
  element.length = length;
  element.area = section.area();
  element.shape_factor = section.shape_factor();
  element.electric_law = electric_law(material, scene.units.eps0());
  element.inertia = muscle.lumped.inertia;
  return element;
}

/// From the control's quantity to the nominal field.
muscles::ControlInput field_input(const TermContext& context, const scene::Muscle& muscle, double length) {
  muscles::ControlInput input;
  if (!muscle.control) return input;
  input.control = context.controls.index(muscle.control->name);
  switch (context.scene.controls.find(muscle.control->name)->value.quantity) {
    case scene::ControlQuantity::layer_voltage:
      input.factor = muscles::field_per_layer_voltage(*muscle.layer_thickness);
      break;
    case scene::ControlQuantity::total_voltage:
      input.factor = muscles::field_per_total_voltage(length);
      break;
    default:
      break;
  }
  return input;
}

void add_observables(TermContext& context, std::vector<model::Observable> observables) {
  for (model::Observable& observable : observables) context.built.model->observables.push_back(std::move(observable));
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

void add_muscles(TermContext& context) {
  std::vector<muscles::TwoPointComponent<muscles::LumpedDea>> attached;
  std::vector<muscles::FreeActuator> free;
  std::vector<base::Diagnostic> errors;
  const int n_bodies = static_cast<int>(context.scene.bodies.size());
  for (const auto& entry : context.scene.muscles) {
    const scene::Muscle& muscle = entry.value;
    if (muscle.ends == scene::MuscleEnds::free) {
      const double length = muscle.rest_length.value_or(*muscle.length);
      const int index = static_cast<int>(free.size());
      free.push_back({entry.name, element_of(context.scene, muscle, length), n_bodies + index, 12 * n_bodies + index,
                      field_input(context, muscle, length)});
      free.back().element.inertia = muscles::Inertia::thesis;
      add_observables(context, muscles::muscle_observables(free.back(), muscle.layer_thickness));
    } else {
      const double length = muscle.rest_length.value_or(distance(context, *muscle.from, *muscle.to));
      if (length <= 0.0) {
        errors.push_back(scene::error_at(entry.origin, "its ends coincide in the scene pose; give its rest_length"));
        continue;
      }
      attached.push_back({entry.name,
                          element_of(context.scene, muscle, length),
                          point_of(context.scene, *muscle.from),
                          point_of(context.scene, *muscle.to),
                          {field_input(context, muscle, length)}});
      add_observables(context, muscles::muscle_observables(attached.back(), muscle.layer_thickness));
    }
    const muscles::LumpedDea& element =
        muscle.ends == scene::MuscleEnds::free ? free.back().element : attached.back().element;
    context.built.assembled.damping |= element.viscosity > 0.0;
    context.built.assembled.electric |= muscle.control.has_value();
  }
  if (!errors.empty()) throw base::InputError(std::move(errors));
  context.built.assembled.muscles = attached.size();
  context.built.assembled.free_actuators = free.size();
  auto& terms = context.built.model->terms;
  if (!attached.empty()) {
    terms.push_back(std::make_unique<muscles::TwoPointTerm<muscles::LumpedDea>>(std::move(attached),
                                                                                to_eigen(context.scene.gravity)));
  }
  if (!free.empty()) terms.push_back(std::make_unique<muscles::FreeActuatorTerm>(std::move(free)));
}

void add_springs(TermContext& context) {
  std::vector<muscles::TwoPointComponent<muscles::Spring>> springs;
  for (const auto& entry : context.scene.springs) {
    const scene::Spring& spring = entry.value;
    muscles::Spring element;
    element.stiffness = spring.element.stiffness;
    element.rest_length = spring.element.rest_length.value_or(distance(context, spring.from, spring.to));
    element.damping = spring.element.damping;
    springs.push_back(
        {entry.name, element, point_of(context.scene, spring.from), point_of(context.scene, spring.to), {}});
    add_observables(context, muscles::spring_observables(springs.back()));
    context.built.assembled.damping |= spring.element.damping > 0.0;
  }
  context.built.assembled.springs = springs.size();
  if (springs.empty()) return;
  context.built.model->terms.push_back(
      std::make_unique<muscles::TwoPointTerm<muscles::Spring>>(std::move(springs), to_eigen(context.scene.gravity)));
}

}  // namespace muldi::build
