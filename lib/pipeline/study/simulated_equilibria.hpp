#pragma once
/// Equilibria of a scene with their exact sensitivities to parameters: A w + B^T dmu = dr/dp, B w = -dg/dp with the
/// tangent of the equilibrium solver and dr/dp at the frozen configuration.
#include <vector>

#include "pipeline/outcome.hpp"
#include "pipeline/study/parameters.hpp"
#include "statics/equilibrium.hpp"

namespace muldi::pipeline {

struct RecordedColumn;

/// One equilibrium of a load curve.
struct EquilibriumPoint {
  double load = 0.0;
  statics::StaticState state = {};
};

/// Follows the statics of the scene and keeps every recorded equilibrium.
Outcome find_equilibria(const scene::Scene& scene, const build::BuiltModel& built,
                        std::vector<EquilibriumPoint>& points);

/// These columns of /statics at equilibria (points, columns).
Eigen::MatrixXd observe_equilibria(const scene::Scene& scene, const build::BuiltModel& built,
                                   const std::vector<EquilibriumPoint>& points,
                                   const std::vector<RecordedColumn>& columns);

/// d observe_equilibria/dp, one matrix a parameter (points, columns).
std::vector<Eigen::MatrixXd> equilibrium_sensitivities(const scene::Scene& scene, const build::BuiltModel& built,
                                                       const std::vector<EquilibriumPoint>& points,
                                                       const std::vector<std::vector<Variant>>& variants,
                                                       const std::vector<RecordedColumn>& columns);

/// Minimal increments a unit of the parameter of the equilibrium under the controls at t = 0 (n_v).
Eigen::VectorXd equilibrium_sensitivity(const scene::Scene& scene, const build::BuiltModel& built,
                                        const Eigen::VectorXd& x, std::span<const Variant> variants);

}  // namespace muldi::pipeline
