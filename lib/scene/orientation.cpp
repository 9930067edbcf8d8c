#include "scene/orientation.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"

namespace muldi::scene {
namespace {

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec3 scaled(const Vec3& a, double s) { return {s * a[0], s * a[1], s * a[2]}; }

/// Rotation by a unit quaternion.
Mat3 from_quaternion(double w, double x, double y, double z) {
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

/// Rotation about a unit axis (Rodrigues); exact for multiples of a right angle about a coordinate axis.
Mat3 from_axis_angle(const Vec3& n, double angle) {
  const double right_angles = angle / 1.57079632679489661923;
  const double whole = std::round(right_angles);
  double c = std::cos(angle);
  double s = std::sin(angle);
  if (std::abs(right_angles - whole) < 1e-15 * std::max(1.0, std::abs(whole))) {
    const int quarter = static_cast<int>(std::fmod(std::fmod(whole, 4.0) + 4.0, 4.0));
    c = quarter == 0 ? 1.0 : quarter == 2 ? -1.0 : 0.0;
    s = quarter == 1 ? 1.0 : quarter == 3 ? -1.0 : 0.0;
  }
  Mat3 matrix;
  const Mat3 skew{{{0, -n[2], n[1]}, {n[2], 0, -n[0]}, {-n[1], n[0], 0}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) matrix[i][j] = (i == j ? c : 0.0) + s * skew[i][j] + (1 - c) * n[i] * n[j];
  }
  return matrix;
}

Mat3 product(const Mat3& a, const Mat3& b) {
  Mat3 c{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
  }
  return c;
}

/// Largest deviation of the rows from orthonormality.
double deviation(const Mat3& m) {
  double largest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j <= i; ++j) largest = std::max(largest, std::abs(dot(m[i], m[j]) - (i == j ? 1.0 : 0.0)));
  }
  return largest;
}

std::string take_matrix(const Mat3& given, Mat3& matrix) {
  const double off = deviation(given);
  if (!(off < 1e-4)) return "the rows must be orthonormal, they are off by " + base::number_text(off, 2);
  if (dot(cross(given[0], given[1]), given[2]) < 0) return "the matrix is a reflection, its determinant is -1";
  matrix = given;
  if (off < 1e-14) return {};
  matrix[0] = scaled(matrix[0], 1 / std::sqrt(dot(matrix[0], matrix[0])));
  const double along = dot(matrix[0], matrix[1]);
  for (std::size_t i = 0; i < 3; ++i) matrix[1][i] -= along * matrix[0][i];
  matrix[1] = scaled(matrix[1], 1 / std::sqrt(dot(matrix[1], matrix[1])));
  matrix[2] = cross(matrix[0], matrix[1]);
  return {};
}

}  // namespace

std::string to_matrix(const OrientationForm& form, Mat3& matrix) {
  const bool axis_angle = form.axis || form.angle;
  const int n_forms =
      int{axis_angle} + int{form.euler.has_value()} + int{form.quaternion.has_value()} + int{form.matrix.has_value()};
  if (n_forms != 1) return "needs one of {axis, angle}, {euler}, {quaternion}, {matrix}";
  if (axis_angle) {
    if (!form.axis || !form.angle) return "needs both axis and angle";
    const double norm = std::sqrt(dot(*form.axis, *form.axis));
    if (norm == 0.0) return "the axis is zero";
    matrix = from_axis_angle(scaled(*form.axis, 1 / norm), *form.angle);
  } else if (form.euler) {
    const Vec3& angles = *form.euler;
    matrix = product(from_axis_angle({0, 0, 1}, angles[2]),
                     product(from_axis_angle({0, 1, 0}, angles[1]), from_axis_angle({1, 0, 0}, angles[0])));
  } else if (form.quaternion) {
    const auto& q = *form.quaternion;
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(std::abs(norm - 1) < 1e-3)) return "the quaternion needs norm 1, it has " + base::number_text(norm, 6);
    matrix = from_quaternion(q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm);
  } else {
    return take_matrix(*form.matrix, matrix);
  }
  return {};
}

}  // namespace muldi::scene
