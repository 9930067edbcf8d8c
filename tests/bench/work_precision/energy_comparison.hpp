#pragma once
/// What integrators keep of the energy of the lumped joint without viscosity.
#include "bench/work_precision/work_report.hpp"

namespace muldi::bench {

/// Adds the energy's departure and its drift over `end` ms, ours and the rivals', with `budget` s of repetitions a run.
void compare_energies(WorkReport& report, double end, double budget);

}  // namespace muldi::bench
