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
void add_loads(TermContext& context);
/// Springs, dampers, drives and stops of joints; needs the manifold.
void add_joint_forces(TermContext& context);

}  // namespace muldi::build
