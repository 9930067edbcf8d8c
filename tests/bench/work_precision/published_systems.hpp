#pragma once
/// The systems of three scenes with their constants written out again, so that a wrong reading of a scene shows.
#include <memory>

#include "bench/work_precision/minimal_system.hpp"

namespace muldi::bench {

/// scenes/revolute_joint_lumped.yaml; `viscosity` in MPa ms, 10 there.
std::unique_ptr<MinimalSystem> lumped_joint(double viscosity);
/// scenes/elephant_trunk_lumped.yaml.
std::unique_ptr<MinimalSystem> lumped_trunk();
/// scenes/membrane_lumped.yaml.
std::unique_ptr<MinimalSystem> lumped_membrane();

}  // namespace muldi::bench
