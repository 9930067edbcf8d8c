#pragma once
/// The motion of a lumped scene with its exact sensitivities to parameters (numerics, 4.5).
///
/// The discrete equations of motion r_n(theta_{n-1}, theta_n, theta_{n+1}; p) = 0 of control/discrete_dynamics.hpp are
/// differentiated once they are solved:
///
///     r_n,next s_{n+1} - G_n^T Z dmu_n = -(r_n,diagonal s_n + r_n,previous s_{n-1} + dr_n/dp),  s = dtheta/dp,
///
/// with the derivatives by theta by hand (those that optimal control uses) and dr_n/dp at the frozen motion
/// (parameters.hpp). Recorded quantities follow by the chain rule along the line theta + s dp.
#include <string>
#include <vector>

#include "control/problem.hpp"
#include "pipeline/outcome.hpp"
#include "pipeline/study/parameters.hpp"

namespace muldi::pipeline {

/// A motion that was computed.
struct Motion {
  control::Trajectory path = {};
  std::vector<Eigen::VectorXd> lambda = {};  ///< impulses Z mu of the loops at the nodes (n_loop_rows)
};

/// A place in the rows of a data set of the result.
struct RecordedColumn {
  std::string path = {};  ///< with slashes
  std::size_t component = 0;
};

/// Runs the dynamics of the scene and keeps the coordinates of every node.
Outcome simulate(const scene::Scene& scene, const build::BuiltModel& built, Motion& motion);

/// These columns at every node of a motion, one column of the matrix each (nodes, columns).
Eigen::MatrixXd observe(const scene::Scene& scene, const build::BuiltModel& built, const control::Trajectory& path,
                        const std::vector<RecordedColumn>& columns);

/// dobserve/dp of a motion, one matrix a parameter (nodes, columns).
/// InputError for what cannot be differentiated.
std::vector<Eigen::MatrixXd> sensitivities(const scene::Scene& scene, const build::BuiltModel& built,
                                           const Motion& motion, const std::vector<std::vector<Variant>>& variants,
                                           const std::vector<RecordedColumn>& columns);

/// Why the dynamics of a scene cannot be differentiated (finite elements, the explicit integrator, an earlier record as
/// the start); empty if they can.
std::string why_not_differentiable(const scene::Scene& scene, const build::BuiltModel& built);

}  // namespace muldi::pipeline
