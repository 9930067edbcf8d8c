#pragma once
/// Rotations: elementary matrices, unit quaternions (w, x, y, z) as raw storage, exponential and logarithm.
#include <Eigen/Core>

namespace muldi::math {

/// Rotation by `angle` about coordinate axis 0, 1 or 2.
Eigen::Matrix3d axis_rotation(int axis, double angle);
/// a -> hat(a), hat(a) b = a x b.
Eigen::Matrix3d hat(const Eigen::Vector3d& a);

Eigen::Matrix3d quaternion_matrix(const double* quaternion);
/// The unit quaternion of a rotation matrix with w >= 0.
void matrix_quaternion(const Eigen::Matrix3d& rotation, double* quaternion);
/// Unit quaternion of a rotation vector (rad).
void quaternion_exp(const Eigen::Vector3d& rotation_vector, double* quaternion);
/// The shortest rotation vector, |.| <= pi.
Eigen::Vector3d quaternion_log(const double* quaternion);
/// result = exp(rotation_vector) quaternion, normalised; may alias.
void quaternion_advance(const double* quaternion, const Eigen::Vector3d& rotation_vector, double* result);
/// The rotation vector w with to = exp(w) from.
Eigen::Vector3d quaternion_difference(const double* from, const double* to);

/// Rotation matrix of a unit axis and an angle, and of angles about the fixed axes x, then y, then z.
Eigen::Matrix3d rotation_about(const Eigen::Vector3d& axis, double angle);
Eigen::Matrix3d rotation_from_fixed_axes(const Eigen::Vector3d& angles);

/// A right-handed orthonormal triad whose third column is `axis` (unit); the others are chosen deterministically.
Eigen::Matrix3d triad_about(const Eigen::Vector3d& axis);

}  // namespace muldi::math
