#pragma once
/// Closed loops (numerics 1.9, 5 no. 20).
#include "support/rigid_system.hpp"

namespace muldi::test {

/// A planar four-bar in the xy plane from its ground points and the lengths of crank, coupler and rocker: four revolute
/// joints, bodies 0, 1, 2. `crank_angle` from the ground line; the coupler joint lies on the left of crank tip to
/// ground point B.
struct FourBar {
  double ground = 100.0;
  double crank = 30.0;
  double coupler = 90.0;
  double rocker = 70.0;
  double crank_angle = 1.0;
};
RigidSystem four_bar(const FourBar& form, double gravity);

/// Crank, rod and slider: joints revolute, revolute, revolute and a prismatic one along x to ground.
RigidSystem slider_crank(double gravity);

/// A quick-return: a block on the tip of a crank slides along a rocker, both hinged on a frame that is fixed to ground;
/// joint 4, the sliding one, closes the loop, and its rows turn with the rocker.
RigidSystem quick_return(double gravity);

/// Bennett's over-constrained spatial linkage: four revolutes, opposite links equal, sin(twist)/length equal for all.
RigidSystem bennett(double first_angle);
/// Coordinates (n_x) of the linkage bennett(scene_angle) where its first angle is another one.
Eigen::VectorXd bennett_coordinates(const multibody::TreeManifold& manifold, double scene_angle, double first_angle);

/// Minimal velocities of a system of one freedom at x, with `rate` for the joint that carries `body`.
Eigen::VectorXd admissible_rates(const model::Model& model, const Eigen::VectorXd& x, int body, double rate);
/// The same in the scene pose.
Eigen::VectorXd admissible_rates(const model::Model& model, int body, double rate);

}  // namespace muldi::test
