#pragma once
/// The scene pose: where bodies and connectors are at zero joint coordinates.
#include <vector>

#include "base/diagnostic.hpp"
#include "multibody/joint.hpp"
#include "scene/scene.hpp"

namespace muldi::build {

Eigen::Vector3d to_eigen(const base::Vec3& v);

/// Index of a body in the scene, multibody::ground for `ground`.
int body_index(const scene::Scene& scene, const std::string& name);

/// Poses of all bodies; those with `place:` are put where their joint closes. Bodies that wait for each other are
/// errors.
std::vector<multibody::Pose> place_bodies(const scene::Scene& scene, std::vector<base::Diagnostic>& errors);

/// The radius of the scene about the centroid of its points; makes gaps and increments dimensionless.
double scene_size(const scene::Scene& scene, const std::vector<multibody::Pose>& poses);

}  // namespace muldi::build
