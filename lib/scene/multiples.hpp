#pragma once
/// Times that must be whole multiples of a step.
#include <string>

namespace muldi::scene {

/// Empty if `time` is a whole multiple (at least one) of `step`; else what is wrong, with both neighbouring multiples.
/// `what` names the step in the sentence; `unit` is the unit of time.
std::string why_no_multiple(double time, double step, const std::string& what, const std::string& unit);

}  // namespace muldi::scene
