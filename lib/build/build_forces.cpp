#include "base/error.hpp"
#include "build/build_terms.hpp"
#include "build/place_bodies.hpp"
#include "multibody/cut_joint_forces.hpp"
#include "multibody/loads.hpp"

namespace muldi::build {
namespace {

/// Value `i` of a list that is empty where nothing was said.
double value_at(const std::vector<double>& values, std::size_t i) { return values.empty() ? 0.0 : values[i]; }

struct ScalarMotion {
  std::size_t coordinate;  ///< index among the joint's reported coordinates
  const multibody::Motion& motion;
};

/// The coordinates on which springs may act.
std::vector<ScalarMotion> scalar_motions(const multibody::Joint& joint) {
  std::vector<ScalarMotion> scalars;
  std::size_t coordinate = 0;
  for (const multibody::Motion& motion : joint.pattern.motions) {
    if (motion.kind != multibody::Motion::Kind::ball) scalars.push_back({coordinate, motion});
    coordinate += static_cast<std::size_t>(motion.n_rates());
  }
  return scalars;
}

bool has_any(const scene::Joint& joint, std::size_t i) {
  return value_at(joint.stiffness, i) != 0.0 || value_at(joint.damping, i) != 0.0 || joint.drive(i) != nullptr ||
         (!joint.stops.empty() && joint.stops[i].has_value());
}

void refuse_rotation_vectors(const scene::Entry<scene::Joint>& entry, const multibody::Joint& joint,
                             std::vector<base::Diagnostic>& errors) {
  std::size_t coordinate = 0;
  for (const multibody::Motion& motion : joint.pattern.motions) {
    const auto n = static_cast<std::size_t>(motion.n_rates());
    for (std::size_t i = coordinate; motion.kind == multibody::Motion::Kind::ball && i < coordinate + n; ++i) {
      if (!has_any(entry.value, i)) continue;
      errors.push_back(scene::error_at(entry.origin,
                                       "stiffness, damping, torque and stops act on slides and single angles, not on a "
                                       "rotation vector; use springs between points"));
      return;
    }
    coordinate += n;
  }
}

multibody::JointForce force_of(TermContext& context, const scene::Entry<scene::Joint>& entry,
                               const ScalarMotion& scalar) {
  const scene::Joint& said = entry.value;
  const std::size_t i = scalar.coordinate;
  multibody::JointForce force{.part = "joints/" + entry.name};
  force.stiffness = value_at(said.stiffness, i);
  force.rest = value_at(said.rest, i);
  force.damping = value_at(said.damping, i);
  if (!said.stops.empty() && said.stops[i]) {
    force.stops = {said.stops[i]->range[0], said.stops[i]->range[1], said.stops[i]->stiffness, said.stops[i]->damping};
  }
  if (const scene::Drive* drive = said.drive(i)) {
    const bool slides = scalar.motion.kind == multibody::Motion::Kind::slide;
    const ControlValue value = context.controls.value_of(
        *drive, slides ? base::dimension::force : base::dimension::torque, "joints." + entry.name);
    force.control = value.control;
    force.constant = value.constant;
  }
  return force;
}

}  // namespace

void add_joint_forces(TermContext& context) {
  std::vector<multibody::TreeJointForce> forces;
  std::vector<multibody::CutJointForce> cut_forces;
  std::vector<base::Diagnostic> errors;
  for (std::size_t j = 0; j < context.scene.joints.size(); ++j) {
    const auto& entry = context.scene.joints[j];
    const multibody::Joint& joint = context.built.joint(j);
    const multibody::TreeLink* link = context.built.link_of_joint(j);
    refuse_rotation_vectors(entry, joint, errors);
    for (const ScalarMotion& scalar : scalar_motions(joint)) {
      if (!has_any(entry.value, scalar.coordinate)) continue;
      const multibody::JointForce law = force_of(context, entry, scalar);
      context.built.assembled.damping |= law.damping > 0.0;
      if (link == nullptr) {
        cut_forces.push_back({law, multibody::JointCoordinate(joint, scalar.motion)});
        continue;
      }
      // Scalar coordinates come before a ball in x, so a scalar's index in x is that of its coordinate.
      const auto k = static_cast<int>(scalar.coordinate);
      forces.push_back({law, link->first_coordinate + k, link->first_rate + k});
    }
  }
  if (!errors.empty()) throw base::InputError(std::move(errors));
  context.built.assembled.joint_forces = forces.size() + cut_forces.size();
  auto& terms = context.built.model->terms;
  if (!forces.empty()) terms.push_back(std::make_unique<multibody::JointForces>(std::move(forces)));
  if (!cut_forces.empty()) terms.push_back(std::make_unique<multibody::CutJointForces>(std::move(cut_forces)));
}

void add_loads(TermContext& context) {
  std::vector<multibody::Load> loads;
  for (const auto& entry : context.scene.loads) {
    const scene::Load& said = entry.value;
    multibody::Load load;
    load.name = entry.name;
    load.kind = said.force ? multibody::Load::Kind::force : multibody::Load::Kind::torque;
    load.frame = said.frame == scene::LoadFrame::world ? multibody::Load::Frame::world : multibody::Load::Frame::body;
    load.body = body_index(context.scene, said.body.name);
    if (said.at) load.point = to_eigen(said.at->position);
    load.direction = to_eigen(said.force ? *said.force : *said.torque);
    scene::Drive drive;
    if (said.control) drive.control = *said.control;
    if (said.magnitude) drive.value = *said.magnitude;
    const ControlValue value = context.controls.value_of(
        drive, said.force ? base::dimension::force : base::dimension::torque, "loads." + entry.name);
    load.control = value.control;
    load.constant = value.constant;
    loads.push_back(std::move(load));
  }
  context.built.assembled.loads = loads.size();
  if (!loads.empty()) context.built.model->terms.push_back(std::make_unique<multibody::Loads>(std::move(loads)));
}

}  // namespace muldi::build
