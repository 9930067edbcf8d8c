#include "transformed_scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

namespace muldi::golden {
namespace {

using scene::Vec3;

Eigen::Vector3d to_eigen(const Vec3& v) { return {v[0], v[1], v[2]}; }
Vec3 to_array(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

void turn(const RigidMotion& motion, Vec3& direction) { direction = to_array(motion.rotation * to_eigen(direction)); }
void turn(const RigidMotion& motion, std::optional<Vec3>& direction) {
  if (direction) turn(motion, *direction);
}

void move(const RigidMotion& motion, scene::Attachment& end) {
  if (end.on_ground()) end.at.position = to_array(motion.point(to_eigen(end.at.position)));
}
void move(const RigidMotion& motion, std::optional<scene::Attachment>& end) {
  if (end) move(motion, *end);
}

void turn(const RigidMotion& motion, scene::Orientation& orientation) {
  Eigen::Matrix3d axes;
  for (int i = 0; i < 3; ++i) axes.row(i) = to_eigen(orientation.matrix[static_cast<std::size_t>(i)]);
  axes = motion.rotation * axes;
  for (int i = 0; i < 3; ++i) orientation.matrix[static_cast<std::size_t>(i)] = to_array(axes.row(i));
}

void turn(const RigidMotion& motion, scene::Joint& joint) {
  using scene::JointFrame;
  const bool world = joint.frame == JointFrame::scene || (joint.frame == JointFrame::from && joint.from.on_ground()) ||
                     (joint.frame == JointFrame::to && joint.to.on_ground());
  if (!world) return;
  std::visit(
      [&](auto& type) {
        if constexpr (requires { type.axis; }) turn(motion, type.axis);
        if constexpr (requires { type.axis2; }) turn(motion, type.axis2);
        if constexpr (requires { type.normal; }) turn(motion, type.normal);
      },
      joint.type);
}

template <class T>
scene::Named<T> in_random_order(const scene::Named<T>& section, std::mt19937& random) {
  std::vector<scene::Entry<T>> entries(section.begin(), section.end());
  std::shuffle(entries.begin(), entries.end(), random);
  scene::Named<T> result;
  for (scene::Entry<T>& entry : entries) result.add(std::move(entry));
  return result;
}

}  // namespace

RigidMotion random_motion(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return Eigen::Vector3d(uniform(random), uniform(random), uniform(random)); };
  const Eigen::AngleAxisd turn(std::numbers::pi * uniform(random), vector().normalized());
  return {.rotation = turn.toRotationMatrix(), .translation = size * vector()};
}

scene::Scene moved(scene::Scene scene, const RigidMotion& motion) {
  turn(motion, scene.gravity);
  for (auto& body : scene.bodies) {
    if (body.value.position) *body.value.position = to_array(motion.point(to_eigen(*body.value.position)));
    turn(motion, body.value.orientation);
  }
  for (auto& joint : scene.joints) {
    move(motion, joint.value.from);
    move(motion, joint.value.to);
    turn(motion, joint.value);
  }
  for (auto& muscle : scene.muscles) {
    move(motion, muscle.value.from);
    move(motion, muscle.value.to);
    turn(motion, muscle.value.axis);
  }
  for (auto& spring : scene.springs) {
    move(motion, spring.value.from);
    move(motion, spring.value.to);
  }
  for (auto& load : scene.loads) {
    if (load.value.frame != scene::LoadFrame::world) continue;
    turn(motion, load.value.force);
    turn(motion, load.value.torque);
  }
  for (auto& body : scene.initial.bodies) {
    turn(motion, body.value.velocity);
    turn(motion, body.value.angular_velocity);
  }
  return scene;
}

scene::Scene shuffled(scene::Scene scene, std::mt19937& random) {
  scene.bodies = in_random_order(scene.bodies, random);
  scene.joints = in_random_order(scene.joints, random);
  scene.muscles = in_random_order(scene.muscles, random);
  scene.springs = in_random_order(scene.springs, random);
  return scene;
}

}  // namespace muldi::golden
