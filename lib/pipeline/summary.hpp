#pragma once
/// What `validate` says of a scene, counted from the built model.
#include <string>

#include "build/built_model.hpp"

namespace muldi::pipeline {

/// Bodies, joints, chains, unknowns, terms that are and are not assembled, linear solver, estimated memory.
std::string summary(const scene::Scene& scene, const build::BuiltModel& built);

}  // namespace muldi::pipeline
