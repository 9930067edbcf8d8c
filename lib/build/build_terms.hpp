#pragma once
/// Terms and observables of muscles, springs, loads and joint forces.
#include <vector>

#include "build/build_controls.hpp"
#include "build/built_model.hpp"
#include "model/supply.hpp"

namespace muldi::build {

/// What the builders of terms read and add to.
struct TermContext {
  const scene::Scene& scene;
  const std::vector<multibody::Pose>& poses;
  ControlTable& controls;
  BuiltModel& built;
};

/// Reference lengths of the isolated actuators, in the order of the scene: the plain unknowns of the manifold.
std::vector<double> free_lengths(const scene::Scene& scene);

/// The map of an attachment.
model::LinearPoint point_of(const scene::Scene& scene, const scene::Attachment& end);

/// What the scene records of sources and conductors.
model::ElectricRecord electric_record(const scene::Scene& scene);

void add_muscles(TermContext& context);
void add_springs(TermContext& context);
/// Guards of the dielectrics whose strength is given, after all muscles and solids.
void add_guards(TermContext& context);
/// Warns of lumped muscles whose control exceeds the strength of their material in the undeformed muscle already; call
/// once the model has its controls.
void note_strong_fields(const scene::Scene& scene, BuiltModel& built);
void add_loads(TermContext& context);
/// Springs, dampers, drives and stops of joints; needs the manifold.
void add_joint_forces(TermContext& context);

}  // namespace muldi::build
