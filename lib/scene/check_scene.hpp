#pragma once
/// What the fields of a scene say together: references, geometry of joints, physics of bodies and materials.
#include "scene/node.hpp"
#include "scene/read_context.hpp"
#include "scene/scene.hpp"

namespace muldi::scene {

/// Checks the scene that was read from `root`, puts the coordinates of named points where they are used, and reports
/// everything that is wrong. What has been reported by the reader is not checked again.
void check_scene(Scene& scene, const Node& root, ReadContext& context);

}  // namespace muldi::scene
