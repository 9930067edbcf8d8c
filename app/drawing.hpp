#pragma once
/// How a scene is drawn.
#include "results/drawing.hpp"
#include "scene/scene.hpp"

namespace muldi::app {

/// Boxes about the points of the bodies, lines of muscles and springs, joints. A body without points gets the box of
/// equal mass and inertia; in directions in which its points do not spread, some thickness.
results::Drawing drawing_of(const scene::Scene& scene);

/// That of the scene that a result file was made with; empty if it cannot be read any more.
results::Drawing drawing_in(const std::string& result_path);

}  // namespace muldi::app
