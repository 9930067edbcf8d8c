#pragma once
/// The derivatives of all solids of a built model, for checks.
#include "build/built_model.hpp"
#include "fem/solid/solid_check.hpp"

namespace muldi::build {

/// fem::check_solid of every solid and every meshed muscle at a state of the whole system.
void check_solids(const BuiltModel& built, const fem::SolidProbe& probe, const fem::DerivativeSink& sink);

}  // namespace muldi::build
