#pragma once
/// What is recorded of muscles, isolated actuators and springs (scene-format, section 4).
#include <optional>
#include <vector>

#include "model/observable.hpp"
#include "muscles/free_actuator_term.hpp"
#include "muscles/lumped_dea.hpp"
#include "muscles/spring.hpp"
#include "muscles/two_point_term.hpp"

namespace muldi::muscles {

/// muscles/<name>/length, stretch, force (> 0 pulls), field, true_field, and layer_voltage and charge (of one layer)
/// where the reference thickness of a layer is known. The component is copied.
std::vector<model::Observable> muscle_observables(const TwoPointComponent<LumpedDea>& muscle,
                                                  std::optional<double> layer_thickness);

/// The same of an isolated actuator.
std::vector<model::Observable> muscle_observables(const FreeActuator& actuator, std::optional<double> layer_thickness);

/// springs/<name>/length, force (> 0 pulls, damping included).
std::vector<model::Observable> spring_observables(const TwoPointComponent<Spring>& spring);

}  // namespace muldi::muscles
