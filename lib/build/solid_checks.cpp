#include "build/solid_checks.hpp"

namespace muldi::build {

void check_solids(const BuiltModel& built, const fem::SolidProbe& probe, const fem::DerivativeSink& sink) {
  for (const fem::Solid* solid : built.solids) fem::check_solid(*solid, probe, sink);
}

}  // namespace muldi::build
