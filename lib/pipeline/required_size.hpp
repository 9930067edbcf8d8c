#pragma once
/// What a scene takes of memory and disk, estimated from the built model, and the refusal of what cannot be had.
#include <string>

#include "build/built_model.hpp"

namespace muldi::pipeline {

/// Bytes of the states, of the mechanism's tangent, of the dense matrices of its statics and, at the least, of the
/// matrix of an optimisation; those of meshes not counted, which have their own guard when they are built.
double memory_bytes(const scene::Scene& scene, const build::BuiltModel& built);

/// Bytes of the results before compression.
double result_bytes(const scene::Scene& scene, const build::BuiltModel& built);

/// Throws InputError where the memory is more than this machine has, or the results more than the whole disk of
/// `output` (a file that need not exist; empty: a file in the current folder) can hold.
void require_size(const scene::Scene& scene, const build::BuiltModel& built, const std::string& output = {});

/// The same for scenes whose results stay in memory, as those of the points of a sweep and of a fit do: InputError
/// where both together are more than this machine has.
void require_size_in_memory(const scene::Scene& scene, const build::BuiltModel& built);

}  // namespace muldi::pipeline
