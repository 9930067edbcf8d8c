#pragma once
/// Random multibody systems: any joints, numbering, orientations and directions.
#include <random>
#include <vector>

#include "support/rigid_system.hpp"

namespace muldi::test {

/// Components in (-size, size).
Eigen::Vector3d random_vector(std::mt19937& random, double size);
Eigen::Matrix3d random_rotation(std::mt19937& random);
/// Position up to `size` in each direction.
multibody::Pose random_pose(std::mt19937& random, double size);
Eigen::VectorXd random_entries(std::mt19937& random, Eigen::Index n, double size);

/// The patterns of multibody::JointTypes.
const std::vector<multibody::JointPattern>& joint_patterns();

struct TreeShape {
  int n_bodies = 6;
  int n_chains = 2;
  bool with_fixed_joints = false;
};

/// A forest of n_chains chains; each is anchored or free at random, bodies and joints are shuffled, joints turned
/// round.
RigidSystem random_forest(std::mt19937& random, const TreeShape& shape);

/// Numbering: body i of the result is body order[i] of the system; joints come in the order `joints`.
RigidSystem renumbered(const RigidSystem& system, const std::vector<int>& bodies, const std::vector<int>& joints);
std::vector<int> random_order(std::mt19937& random, int n);

/// Coordinates anywhere: the reference moved along a random increment of the size of 1 rad or of `length`/10.
Eigen::VectorXd random_coordinates(std::mt19937& random, const model::Manifold& manifold);

}  // namespace muldi::test
