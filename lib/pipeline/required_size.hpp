#pragma once
/// What a scene takes of memory and disk, estimated from the built model, and the refusal of what cannot be had.
#include <string>

#include "build/built_model.hpp"

namespace muldi::pipeline {

/// Bytes of the states, of the mechanism's tangent and of the dense matrices of its statics; those of meshes not
/// counted, which have their own guard when they are built.
double memory_bytes(const scene::Scene& scene, const build::BuiltModel& built);

/// Bytes of the results before compression.
double result_bytes(const scene::Scene& scene, const build::BuiltModel& built);

/// Throws InputError where the memory is more than this machine has, or the results more than the whole disk of
/// `output` (a file that need not exist; empty: a file in the current folder) can hold.
void require_size(const scene::Scene& scene, const build::BuiltModel& built, const std::string& output = {});

}  // namespace muldi::pipeline
