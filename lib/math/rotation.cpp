#include "math/rotation.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace muldi::math {
namespace {

Eigen::Quaterniond load(const double* q) { return {q[0], q[1], q[2], q[3]}; }

void store(const Eigen::Quaterniond& q, double* out) {
  out[0] = q.w();
  out[1] = q.x();
  out[2] = q.y();
  out[3] = q.z();
}

Eigen::Quaterniond exponential(const Eigen::Vector3d& w) {
  const double half = 0.5 * w.norm();
  // sin(half)/(2 half): the series is exact to round-off below 1e-4 and avoids 0/0.
  const double factor = half < 1e-4 ? 0.5 - half * half / 12.0 : 0.5 * std::sin(half) / half;
  return {std::cos(half), factor * w.x(), factor * w.y(), factor * w.z()};
}

Eigen::Vector3d logarithm(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();
  const double half = std::atan2(sine, sign * q.w());
  const double factor = sine < 1e-8 ? 2.0 : 2.0 * half / sine;
  return sign * factor * q.vec();
}

}  // namespace

Eigen::Matrix3d axis_rotation(int axis, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const int j = (axis + 1) % 3;
  const int k = (axis + 2) % 3;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
  rotation(axis, axis) = 1.0;
  rotation(j, j) = c;
  rotation(k, k) = c;
  rotation(j, k) = -s;
  rotation(k, j) = s;
  return rotation;
}

Eigen::Matrix3d hat(const Eigen::Vector3d& a) {
  Eigen::Matrix3d result;
  result << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return result;
}

Eigen::Matrix3d quaternion_matrix(const double* quaternion) { return load(quaternion).toRotationMatrix(); }

void matrix_quaternion(const Eigen::Matrix3d& rotation, double* quaternion) {
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  store(q.normalized(), quaternion);
}

void quaternion_exp(const Eigen::Vector3d& rotation_vector, double* quaternion) {
  store(exponential(rotation_vector), quaternion);
}

Eigen::Vector3d quaternion_log(const double* quaternion) { return logarithm(load(quaternion)); }

void quaternion_advance(const double* quaternion, const Eigen::Vector3d& rotation_vector, double* result) {
  store((exponential(rotation_vector) * load(quaternion)).normalized(), result);
}

Eigen::Vector3d quaternion_difference(const double* from, const double* to) {
  return logarithm(load(to) * load(from).conjugate());
}

Eigen::Matrix3d rotation_about(const Eigen::Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

Eigen::Matrix3d rotation_from_fixed_axes(const Eigen::Vector3d& angles) {
  return axis_rotation(2, angles.z()) * axis_rotation(1, angles.y()) * axis_rotation(0, angles.x());
}

Eigen::Matrix3d triad_about(const Eigen::Vector3d& axis) {
  Eigen::Index smallest = 0;
  axis.cwiseAbs().minCoeff(&smallest);
  Eigen::Matrix3d triad;
  triad.col(2) = axis.normalized();
  const Eigen::Vector3d unit = Eigen::Vector3d::Unit(smallest);
  triad.col(0) = (unit - unit.dot(triad.col(2)) * triad.col(2)).normalized();
  triad.col(1) = triad.col(2).cross(triad.col(0));
  return triad;
}

}  // namespace muldi::math
