#pragma once
/// A joint between two bodies of a system: connectors, triads, relative pose, coordinates (numerics, 1.7).
#include <Eigen/Core>
#include <string>
#include <vector>

#include "model/bilinear.hpp"
#include "multibody/joint_pattern.hpp"

namespace muldi::multibody {

/// Index of ground where a body is expected.
inline constexpr int ground = -1;

/// Position and orientation of a body: centre of mass and directors as columns.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d orientation = Eigen::Matrix3d::Identity();

  Eigen::Vector3d point(const Eigen::Vector3d& local) const { return position + orientation * local; }
};

/// Ground vectors are world vectors; body vectors are in body axes from the centre of mass.
struct Joint {
  std::string name;
  JointPattern pattern;
  int body_a = ground;                                    ///< from
  int body_b = ground;                                    ///< to
  Eigen::Vector3d rho_a = Eigen::Vector3d::Zero();        ///< connector on A
  Eigen::Vector3d rho_b = Eigen::Vector3d::Zero();        ///< connector on B
  Eigen::Matrix3d triad_a = Eigen::Matrix3d::Identity();  ///< e^A = R_A triad_a
  Eigen::Matrix3d triad_b = Eigen::Matrix3d::Identity();  ///< e^B = R_B triad_b
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();       ///< e^A components of p where the coordinates are zero

  /// Reads connectors and triads off a pose of the scene: both triads become `triad` (world, columns), slides start at
  /// zero.
  void align(const Pose& a, const Pose& b, const Eigen::Matrix3d& triad);
};

/// Relative pose of B's triad in A's: p and rotation, both in e^A components.
struct RelativePose {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
};

/// Relative pose from coordinates (pattern.n_coordinates()).
RelativePose relative_pose(const Joint& joint, const double* coordinates);
/// The pose of B, given that of A, or of A, given that of B.
Pose pose_of_b(const Joint& joint, const RelativePose& relative, const Pose& a);
Pose pose_of_a(const Joint& joint, const RelativePose& relative, const Pose& b);
/// The relative pose that two bodies have.
RelativePose measure(const Joint& joint, const Pose& a, const Pose& b);

/// Coordinates of a relative pose; angles are the representatives nearest to those in `near`.
void coordinates_of(const Joint& joint, const RelativePose& relative, const double* near, double* coordinates);
/// What users read: slides and angles as they are, a ball as its rotation vector (pattern.n_rates()).
void reported_coordinates(const Joint& joint, const double* coordinates, double* reported);
/// Stored coordinates from reported ones.
void stored_coordinates(const Joint& joint, const double* reported, double* coordinates);
/// coordinates_new = coordinates moved by rates * 1 (pattern.n_rates()); may alias.
void advance_coordinates(const Joint& joint, const double* coordinates, const double* rates, double* coordinates_new);
/// The rates that lead from one set of coordinates to another.
void coordinate_difference(const Joint& joint, const double* from, const double* to, double* rates);

/// Scalar constraints as bilinear forms of q; translations are divided by `length`, so that all rows are angles in
/// size. `bodies_at`: body i has its twelve unknowns at 12 i.
std::vector<model::Bilinear> constraint_rows(const Joint& joint, double length);

/// The map of a point of a body (or of ground) and of a direction fixed in it.
model::LinearPoint body_point(int body, const Eigen::Vector3d& local);
model::LinearPoint body_direction(int body, const Eigen::Vector3d& local);

}  // namespace muldi::multibody
