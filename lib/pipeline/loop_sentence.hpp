#pragma once
/// What a time loop says of its end, with the times that only a scene can write.
#include <string>

#include "scene/scene.hpp"
#include "variational/time_loop.hpp"

namespace muldi::pipeline {

/// The sentence of a loop's result; of a breakdown with the time of the node that was refused, in the scene's unit.
std::string loop_sentence(const variational::LoopResult& result, const scene::Scene& scene);

}  // namespace muldi::pipeline
