#pragma once
/// The systems of three scenes with their constants written out again, so that a wrong reading of a scene shows.
#include <memory>
#include <vector>

#include "bench/work_precision/joint_chain.hpp"

namespace muldi::bench {

/// A chain as plain numbers, for rivals that build their own system from it.
struct ChainParts {
  std::vector<ChainLink> links;
  std::vector<ChainMuscle> muscles;
};

inline constexpr double muscle_density = 1e-3;  ///< g/mm^3

/// scenes/revolute_joint_lumped.yaml; `viscosity` in MPa ms, 10 there; density of the muscles.
ChainParts joint_parts(double viscosity, double density);
/// scenes/elephant_trunk_lumped.yaml; density of the muscles.
ChainParts trunk_parts(double density);

std::unique_ptr<MinimalSystem> system_of(ChainParts parts);
/// scenes/membrane_lumped.yaml.
std::unique_ptr<MinimalSystem> lumped_membrane();

}  // namespace muldi::bench
