#pragma once
/// The state at t = 0 that a scene asks for.
#include <optional>

#include "build/built_model.hpp"
#include "pipeline/outcome.hpp"
#include "results/recorder.hpp"
#include "statics/equilibrium.hpp"
#include "variational/state.hpp"

namespace muldi::pipeline {

/// Coordinates with the given joint positions and closed loops (least-norm correction of the others); InputError if the
/// positions contradict the loops, or for a pose that no element can have (ends that coincide).
Eigen::VectorXd initial_coordinates(const scene::Scene& scene, const build::BuiltModel& built);

/// The pose of initial_coordinates with the solids in their reference, or led by the bodies to which they are tied, at
/// rest with all controls zero. InputError if they find no rest there.
statics::StaticState starting_point(const scene::Scene& scene, const build::BuiltModel& built);

/// Moves `state` to the static equilibrium under the controls at t = 0; the outcome is not completed if there is none.
Outcome settle(const scene::Scene& scene, const build::BuiltModel& built, statics::StaticState& state);

/// Minimal velocities of the given joint and body velocities (least norm); InputError if they contradict each other or
/// the loops, and for momenta of joints that cannot have them.
Eigen::VectorXd initial_rates(const scene::Scene& scene, const build::BuiltModel& built, const Eigen::VectorXd& x);

/// The state at t = 0; `earlier` is the checkpoint of the record that `initial.from` names.
Outcome initial_state(const scene::Scene& scene, const build::BuiltModel& built,
                      const std::optional<results::Checkpoint>& earlier, variational::State& state);

}  // namespace muldi::pipeline
