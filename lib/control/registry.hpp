#pragma once
/// The objectives of optimal control; a new one is a header and a place in the list.
///
/// An objective is plain data with
///
///     static constexpr std::string_view name;
///     template <class Sum> void contribute(Sum& sum) const;   // its terms, by the calls of control/objective_sum.hpp
#include "base/describe.hpp"
#include "control/objectives/effort.hpp"
#include "control/objectives/feasibility.hpp"
#include "control/objectives/final_time.hpp"
#include "control/objectives/kinetic_energy.hpp"
#include "control/objectives/peak_field.hpp"
#include "control/objectives/rate.hpp"
#include "control/objectives/terminal.hpp"
#include "control/objectives/tracking.hpp"

namespace muldi::control {

using ObjectiveTypes =
    base::TypeList<Feasibility, Effort, Rate, FinalTime, Tracking, Terminal, KineticEnergy, PeakField>;

/// One objective with its data.
using Objective = base::VariantOf<ObjectiveTypes>;

}  // namespace muldi::control
