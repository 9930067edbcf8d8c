#pragma once
/// The forms in which a scene gives an orientation.
#include <array>
#include <optional>
#include <string>

#include "base/describe.hpp"
#include "scene/bodies.hpp"

namespace muldi::scene {

/// Exactly one of: axis with angle, euler, quaternion, matrix.
struct OrientationForm {
  std::optional<Vec3> axis = {};
  std::optional<double> angle = {};
  std::optional<Vec3> euler = {};                        ///< angles about the fixed x, then y, then z axis
  std::optional<std::array<double, 4>> quaternion = {};  ///< w, x, y, z
  std::optional<Mat3> matrix = {};                       ///< columns are the body axes

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "axis", .doc = "axis of the rotation, of any length", .need = optional}, self.axis);
    visit(Field{.key = "angle", .doc = "angle about `axis`", .unit = dimension::angle, .need = optional}, self.angle);
    visit(Field{.key = "euler",
                .doc = "angles about the fixed x, then y, then z axis",
                .unit = dimension::angle,
                .need = optional},
          self.euler);
    visit(Field{.key = "quaternion", .doc = "unit quaternion w, x, y, z", .need = optional}, self.quaternion);
    visit(Field{.key = "matrix", .doc = "rotation matrix by rows; its columns are the body axes", .need = optional},
          self.matrix);
  }
};

/// The rotation matrix of the form in `matrix`, orthonormal to round-off. Otherwise a sentence: no or several forms, a
/// zero axis, a quaternion or matrix that is not near a rotation (1e-3 in norm, 1e-4 in orthonormality).
std::string to_matrix(const OrientationForm& form, Mat3& matrix);

}  // namespace muldi::scene
