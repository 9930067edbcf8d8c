#pragma once
/// Shocks: generalised momenta of joint coordinates at t = 0.
#include <Eigen/Core>

#include "build/built_model.hpp"

namespace muldi::pipeline {

/// The generalised momenta that the scene gives (n_v); InputError for a joint that closes a loop.
Eigen::VectorXd wanted_momenta(const scene::Scene& scene, const build::BuiltModel& built);

/// Minimal velocities with which the bodies alone have the momenta m at the coordinates x. The nodes of solids have
/// none, not even where they are tied: what they take of the motion, the Legendre transform shows.
Eigen::VectorXd rates_of_momentum(const build::BuiltModel& built, const Eigen::VectorXd& x, const Eigen::VectorXd& m);

}  // namespace muldi::pipeline
