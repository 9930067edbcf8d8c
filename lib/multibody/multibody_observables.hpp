#pragma once
/// What is recorded of bodies, joints and points (scene format, section 4).
#include <string>
#include <vector>

#include "model/observable.hpp"
#include "multibody/joint_coordinate.hpp"
#include "multibody/tree_manifold.hpp"

namespace muldi::multibody {

/// bodies/<name>/position, orientation (directors as columns), velocity, angular_velocity.
std::vector<model::Observable> body_observables(const std::string& name, int body);

/// points/<label>: world position of a body point.
model::Observable point_observable(const std::string& label, int body, const Eigen::Vector3d& local);

/// Coordinates, velocities and reactions of all user joints. Must outlive its observables, as must the manifold.
class JointRecords {
 public:
  explicit JointRecords(const TreeManifold& manifold);

  /// joints/<name>/coordinate, velocity (where the joint moves) and reaction: force and moment on `to` about its
  /// connector, world axes. Where loop constraints are redundant, reactions are those of least norm (numerics, 1.9).
  std::vector<model::Observable> observables();

 private:
  using Wrench = Eigen::Matrix<double, 6, 1>;

  void coordinate(int joint, const model::NodeView& at, std::span<double> out) const;
  void velocity(int joint, const model::NodeView& at, std::span<double> out) const;
  void reaction(int joint, const model::NodeView& at, std::span<double> out);
  void refresh(const model::NodeView& at);
  /// Wrench on body `to` about its centre of mass.
  Wrench tree_wrench(int link) const;
  Wrench cut_wrench(int joint, const model::NodeView& at) const;
  void cut_velocity(const Joint& joint, const model::NodeView& at, std::span<double> out) const;

  const TreeManifold& manifold_;
  const KinematicTree& tree_;
  std::vector<int> link_of_joint_;  ///< -1 for cut joints
  TreeFrame frame_;
  Twists wrenches_;
  Eigen::VectorXd force_;
  long serial_ = -1;
};

}  // namespace muldi::multibody
