#pragma once
/// Joints of the scene as joints of the kinematic tree.
#include <vector>

#include "base/diagnostic.hpp"
#include "multibody/joint.hpp"
#include "scene/scene.hpp"

namespace muldi::build {

/// A joint must close within this fraction of the size of the scene.
inline constexpr double closing_tolerance = 1e-6;

struct JointMessages {
  std::vector<base::Diagnostic>& errors;
  std::vector<base::Diagnostic>& notes;
};

/// Joints in the order of the scene, with triads and offsets of the scene pose. Small gaps are set to zero (the body
/// that hangs on the joint moves) and noted, larger ones are errors.
std::vector<multibody::Joint> build_joints(const scene::Scene& scene, const std::vector<multibody::Pose>& poses,
                                           double size, JointMessages messages);

}  // namespace muldi::build
