#pragma once
/// Scene -> Model.
#include <memory>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "fem/solid/solid_observables.hpp"
#include "model/model.hpp"
#include "multibody/multibody_observables.hpp"
#include "multibody/tree_manifold.hpp"
#include "scene/scene.hpp"

namespace muldi::build {

/// Counts for the summary of `validate`, taken from the built model.
struct Assembled {
  std::size_t muscles = 0;
  std::size_t meshed_muscles = 0;  ///< of the muscles
  std::size_t free_actuators = 0;
  std::size_t springs = 0;
  std::size_t loads = 0;
  std::size_t joint_forces = 0;
  bool damping = false;  ///< any viscous term
  bool gravity = false;
  bool electric = false;  ///< any muscle or solid that can be charged
};

/// Nodes of a solid that are fixed to one body, or to ground.
struct TiedNodes {
  int body = multibody::ground;
  std::string name = {};  ///< of the body
  std::vector<int> nodes = {};
};

/// A muscle that is built from finite elements.
struct MeshedMuscle {
  std::size_t index = 0;  ///< in the scene's muscles
  const fem::Solid* solid = nullptr;
  const fem::SolidRecords* records = nullptr;
};

/// A muscle with a control: its field is `field_factor` times the control.
struct DrivenMuscle {
  std::string name;
  int control = 0;            ///< index in the model's controls
  double field_factor = 1.0;  ///< nominal field by control
  double rest_length = 0.0;
};

/// The model with what it keeps alive, and the way back to the names of the scene.
struct BuiltModel {
  std::unique_ptr<model::Model> model;
  const multibody::TreeManifold* manifold = nullptr;       ///< of the model
  std::unique_ptr<multibody::JointRecords> joint_records;  ///< referred to by observables
  std::vector<const fem::Solid*> solids;  ///< of the model: the scene's solids, attached ones as one, then muscles
  /// Of the scene's solids in order, then of the meshed muscles; referred to by observables.
  std::vector<std::unique_ptr<fem::SolidRecords>> solid_records;
  std::vector<std::unique_ptr<TiedNodes>> ties;  ///< of these, referred to by observables
  std::vector<MeshedMuscle> meshed_muscles;
  std::vector<DrivenMuscle> driven_muscles;
  std::vector<base::Diagnostic> notes;  ///< small gaps that were closed, and the like
  std::size_t n_named_controls = 0;     ///< the scene's controls come first; then functions of drives
  std::string linear = "auto";        ///< linear solver of the bodies that the scene asks for; it can solve this system
  std::string solid_linear = "auto";  ///< the same of the solids
  Assembled assembled;

  /// The joint of the kinematic tree with this index in the scene.
  const multibody::Joint& joint(std::size_t scene_index) const { return manifold->tree().joints[scene_index]; }
  /// The link that a scene joint carries, or null for a loop-closing joint.
  const multibody::TreeLink* link_of_joint(std::size_t scene_index) const;
};

/// Builds everything that the scene holds and nothing else. InputError with all that is wrong (joints that do not
/// close, axes that are not perpendicular, loops that cannot be placed, a linear solver that does not fit), located in
/// the scene.
BuiltModel build_model(const scene::Scene& scene);

}  // namespace muldi::build
