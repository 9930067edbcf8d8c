#include "build/place_bodies.hpp"

#include <algorithm>
#include <cmath>

namespace muldi::build {
namespace {

using multibody::Pose;

Pose pose_in(const std::vector<Pose>& poses, int body) {
  return body == multibody::ground ? Pose{} : poses[static_cast<std::size_t>(body)];
}

/// Centre of mass of `body` so that its end of the joint meets the other end.
Eigen::Vector3d closing_position(const scene::Scene& scene, const scene::Joint& joint, int body,
                                 const std::vector<Pose>& poses) {
  const bool is_to = body_index(scene, joint.to.body.name) == body;
  const scene::Attachment& own = is_to ? joint.to : joint.from;
  const scene::Attachment& other = is_to ? joint.from : joint.to;
  const Pose at = pose_in(poses, body_index(scene, other.body.name));
  return at.point(to_eigen(other.at.position)) -
         poses[static_cast<std::size_t>(body)].orientation * to_eigen(own.at.position);
}

}  // namespace

Eigen::Vector3d to_eigen(const base::Vec3& v) { return {v[0], v[1], v[2]}; }

int body_index(const scene::Scene& scene, const std::string& name) {
  return name == scene::ground ? multibody::ground : scene.bodies.index(name);
}

std::vector<Pose> place_bodies(const scene::Scene& scene, std::vector<base::Diagnostic>& errors) {
  std::vector<Pose> poses(scene.bodies.size());
  std::vector<bool> placed(scene.bodies.size(), false);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const scene::Body& body = scene.bodies[i].value;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        poses[i].orientation(row, column) =
            body.orientation.matrix[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
      }
    }
    if (!body.position) continue;
    poses[i].position = to_eigen(*body.position);
    placed[i] = true;
  }
  for (bool progress = true; progress;) {
    progress = false;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (placed[i]) continue;
      const scene::Joint& joint = scene.joints.find(scene.bodies[i].value.place->joint.name)->value;
      const int from = body_index(scene, joint.from.body.name);
      const int to = body_index(scene, joint.to.body.name);
      const int other = from == static_cast<int>(i) ? to : from;
      if (other != multibody::ground && !placed[static_cast<std::size_t>(other)]) continue;
      poses[i].position = closing_position(scene, joint, static_cast<int>(i), poses);
      placed[i] = true;
      progress = true;
    }
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (placed[i]) continue;
    errors.push_back(scene::error_at(scene.bodies[i].value.place->joint.origin,
                                     "the body on the other side of the joint waits to be placed itself; give one of "
                                     "the bodies of the circle a `position`"));
  }
  return poses;
}

double scene_size(const scene::Scene& scene, const std::vector<Pose>& poses) {
  std::vector<Eigen::Vector3d> points;
  const auto add_end = [&](const scene::Attachment& end) {
    points.push_back(pose_in(poses, body_index(scene, end.body.name)).point(to_eigen(end.at.position)));
  };
  for (const Pose& pose : poses) points.push_back(pose.position);
  for (const auto& joint : scene.joints) {
    add_end(joint.value.from);
    add_end(joint.value.to);
  }
  for (const auto& muscle : scene.muscles) {
    if (muscle.value.from) add_end(*muscle.value.from);
    if (muscle.value.to) add_end(*muscle.value.to);
  }
  for (const auto& spring : scene.springs) {
    add_end(spring.value.from);
    add_end(spring.value.to);
  }
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) centroid += point / static_cast<double>(points.size());
  double radius = 0.0;
  for (const Eigen::Vector3d& point : points) radius = std::max(radius, (point - centroid).norm());
  // A single body without connectors has its radius of gyration for a size.
  for (const auto& body : scene.bodies) {
    double trace = 0.0;
    for (std::size_t k = 0; k < 3; ++k) trace += body.value.inertia.tensor[k][k];
    radius = std::max(radius, std::sqrt(trace / body.value.mass));
  }
  for (const auto& muscle : scene.muscles) radius = std::max(radius, muscle.value.length.value_or(0.0));
  return radius > 0.0 ? radius : 1.0;
}

}  // namespace muldi::build
