#include "build/build_joints.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <optional>

#include "base/text.hpp"
#include "build/place_bodies.hpp"
#include "math/rotation.hpp"

namespace muldi::build {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using multibody::Constraint;
using multibody::Joint;
using multibody::Pose;

/// Two given axes may miss the right angle by this much (rad); the triad is then made exact.
constexpr double perpendicular_tolerance = 1e-6;

/// World triad of the joint from the axes that its type gives; the axes of `from` where it gives none.
std::optional<Matrix3d> triad_of(const scene::Entry<scene::Joint>& entry, const Pose& from, const Pose& to,
                                 std::vector<base::Diagnostic>& errors) {
  const scene::Joint& joint = entry.value;
  const Matrix3d axes = joint.frame == scene::JointFrame::scene  ? Matrix3d(Matrix3d::Identity())
                        : joint.frame == scene::JointFrame::from ? from.orientation
                                                                 : to.orientation;
  std::array<std::optional<Vector3d>, 3> given;
  std::visit(
      [&](const auto& type) {
        type.orient([&](int column, const base::Vec3& vector) {
          given[static_cast<std::size_t>(column)] = (axes * to_eigen(vector)).normalized();
        });
      },
      joint.type);
  if (given[2]) return math::triad_about(*given[2]);
  if (!given[0]) return from.orientation;
  const double off = std::asin(std::min(1.0, std::abs(given[0]->dot(*given[1]))));
  if (off > perpendicular_tolerance) {
    errors.push_back(scene::error_at(
        entry.origin,
        base::format("`axis` and `axis2` must be perpendicular in the scene pose; they miss it by {:.3g} rad", off)));
    return {};
  }
  Matrix3d triad;
  triad.col(0) = *given[0];
  triad.col(2) = given[0]->cross(*given[1]).normalized();
  triad.col(1) = triad.col(2).cross(triad.col(0));
  return triad;
}

/// The part of the offset that the joint forbids, in its triad.
Vector3d forbidden(const Joint& joint) {
  Vector3d gap = Vector3d::Zero();
  for (const Constraint& constraint : joint.pattern.constraints) {
    if (constraint.kind == Constraint::Kind::coincident) gap = joint.offset;
    if (constraint.kind == Constraint::Kind::no_slide) gap[constraint.a] = joint.offset[constraint.a];
  }
  return gap;
}

}  // namespace

std::vector<Joint> build_joints(const scene::Scene& scene, const std::vector<Pose>& poses, double size,
                                JointMessages messages) {
  std::vector<Joint> joints;
  const auto pose = [&](int body) {
    return body == multibody::ground ? Pose{} : poses[static_cast<std::size_t>(body)];
  };
  for (const auto& entry : scene.joints) {
    Joint joint;
    joint.name = entry.name;
    joint.pattern = std::visit([](const auto& type) { return type.pattern; }, entry.value.type);
    joint.body_a = body_index(scene, entry.value.from.body.name);
    joint.body_b = body_index(scene, entry.value.to.body.name);
    joint.rho_a = to_eigen(entry.value.from.at.position);
    joint.rho_b = to_eigen(entry.value.to.at.position);
    const auto triad = triad_of(entry, pose(joint.body_a), pose(joint.body_b), messages.errors);
    if (triad) joint.align(pose(joint.body_a), pose(joint.body_b), *triad);
    const Vector3d gap = forbidden(joint);
    const std::string unit = scene.units.length();
    if (gap.norm() > closing_tolerance * size) {
      messages.errors.push_back(scene::error_at(
          entry.origin, base::format("the joint does not close in the scene pose: its connectors are {:.6g} {} apart",
                                     gap.norm(), unit)));
    } else if (gap.norm() > 1e-12 * size) {
      messages.notes.push_back(scene::warning_at(
          entry.origin, base::format("a gap of {:.3g} {} in the scene pose was closed", gap.norm(), unit)));
    }
    joint.offset -= gap;
    joints.push_back(std::move(joint));
  }
  return joints;
}

}  // namespace muldi::build
