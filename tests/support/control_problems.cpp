#include "support/control_problems.hpp"

#include <algorithm>

#include "math/rotation.hpp"
#include "multibody/registry.hpp"

namespace muldi::test {

using Eigen::Vector3d;

void ControlCase::seek_squares(double upper) {
  for (std::size_t c = 0; c < model->controls.size(); ++c) {
    problem.controls.push_back({.control = static_cast<int>(c),
                                .kind = control::ControlKind::squared,
                                .lower = 0.0,
                                .upper = upper,
                                .reference = upper});
  }
}

void ControlCase::seek_plain(double bound) {
  for (std::size_t c = 0; c < model->controls.size(); ++c) {
    problem.controls.push_back({.control = static_cast<int>(c), .lower = -bound, .upper = bound, .reference = bound});
  }
}

ControlCase joint_case(int n_steps, double step) {
  ControlCase result(muscle_joint(0.0));
  result.set_horizon(n_steps, step);
  result.seek_squares(5e4);
  result.start_at_rest();
  result.problem.final.coordinates.push_back({.name = "joints.hinge", .rate = 0, .value = 7.73 * degree});
  return result;
}

ControlCase trunk_case(int n_steps, double step) {
  ControlCase result(trunk(std::vector<double>(12, 0.0)));
  result.set_horizon(n_steps, step);
  result.seek_squares(4e4);
  result.start_at_rest();
  const End tip = trunk_tip();
  result.problem.final.points.push_back({.name = "points.tip",
                                         .point = multibody::body_point(tip.body, tip.local),
                                         .value = {-95.8341, 274.054, 73.0747}});
  return result;
}

RigidSystem slider(double damping) {
  RigidSystem system;
  system.length = 1.0;
  const int body = system.add_body(2.0, Vector3d::Ones(), {});
  system.connect(multibody::Prismatic::pattern, {multibody::ground, body}, Vector3d::Zero(),
                 math::rotation_about(Vector3d::UnitY(), 90.0 * degree));
  system.joint_forces.push_back({.joint = 0, .damping = damping, .control = 0});
  system.controls.push_back({.name = "force", .unit = base::dimension::force, .function = 0.0});
  return system;
}

RigidSystem driven_free_body() {
  RigidSystem system;
  system.length = 10.0;
  system.gravity = Vector3d(0.0, 0.0, -1e-3);
  const int body = system.add_body(3.0, Vector3d(4.0, 5.0, 6.0), {.position = Vector3d(1.0, 2.0, 3.0)});
  for (int k = 0; k < 3; ++k) {
    system.loads.push_back({.name = "force",
                            .kind = multibody::Load::Kind::force,
                            .frame = k == 0 ? multibody::Load::Frame::body : multibody::Load::Frame::world,
                            .body = body,
                            .point = Vector3d(0.3, 0.2, 0.1),
                            .direction = Vector3d::Unit(k),
                            .control = k});
    system.loads.push_back({.name = "torque",
                            .kind = multibody::Load::Kind::torque,
                            .frame = k == 1 ? multibody::Load::Frame::world : multibody::Load::Frame::body,
                            .body = body,
                            .direction = Vector3d::Unit(k),
                            .control = 3 + k});
  }
  system.springs.push_back({.name = "spring",
                            .element = {.stiffness = 0.02, .rest_length = 2.0, .damping = 0.05},
                            .a1 = {multibody::ground, Vector3d(5.0, 0.0, 1.0)},
                            .a2 = {body, Vector3d(0.5, 0.0, -0.5)}});
  for (int c = 0; c < 6; ++c) system.controls.push_back({.name = "u" + std::to_string(c), .unit = {}, .function = 0.0});
  return system;
}

std::vector<control::WeightedObjective> effort_of_fields(std::size_t n_controls) {
  return {{1.0, control::Effort{.factors = std::vector<double>(n_controls, 1e-6)}}};
}

std::vector<control::WeightedObjective> feasibility() { return {{1.0, control::Feasibility{}}}; }

double sum_of_squares(const control::Trajectory& trajectory) {
  double sum = 0.0;
  for (const auto& u : trajectory.u) {
    for (const double value : u) sum += 1e-6 * value * value;
  }
  return sum;
}

double distance(const model::Model& model, const control::Trajectory& a, const control::Trajectory& b) {
  const model::Manifold& manifold = *model.manifold;
  Eigen::VectorXd increment(manifold.n_v());
  double largest = a.x.size() == b.x.size() ? 0.0 : control::infinity;
  for (std::size_t n = 0; n < std::min(a.x.size(), b.x.size()); ++n) {
    manifold.difference(a.x[n], b.x[n], increment);
    largest = std::max(largest, increment.cwiseQuotient(manifold.rate_scale()).lpNorm<Eigen::Infinity>());
  }
  return largest;
}

}  // namespace muldi::test
