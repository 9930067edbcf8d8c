#pragma once
/// Scenes that must give the same physics as another: moved in space, or written in another order.
#include <Eigen/Core>
#include <random>

#include "scene/scene.hpp"

namespace muldi::golden {

/// x -> rotation x + translation.
struct RigidMotion {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;

  Eigen::Vector3d point(const Eigen::Vector3d& x) const { return rotation * x + translation; }
};

/// A random one, up to `size` far.
RigidMotion random_motion(std::mt19937& random, double size);

/// The scene with everything in it that is given in world axes moved: poses, ground points, axes, gravity, loads,
/// initial velocities.
scene::Scene moved(scene::Scene scene, const RigidMotion& motion);

/// The scene with bodies, joints, muscles and springs in random order.
scene::Scene shuffled(scene::Scene scene, std::mt19937& random);

}  // namespace muldi::golden
