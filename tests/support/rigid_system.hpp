#pragma once
/// Multibody systems built by hand, as a scene would describe them.
#include <Eigen/Dense>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "model/model.hpp"
#include "multibody/cut_joint_forces.hpp"
#include "multibody/loads.hpp"
#include "multibody/rigid_body.hpp"
#include "multibody/tree_manifold.hpp"
#include "muscles/free_actuator_term.hpp"
#include "muscles/lumped_dea.hpp"
#include "muscles/spring.hpp"
#include "muscles/two_point_term.hpp"
#include "variational/state.hpp"

namespace muldi::test {

/// Spring, damper, stops or drive on motion number `motion` of joint number `joint`.
struct CoordinateForce {
  int joint = 0;
  std::size_t motion = 0;
  double stiffness = 0.0;
  double rest = 0.0;
  double damping = 0.0;
  multibody::Stops stops = {};
  int control = -1;
  double control_factor = 1.0;
  double constant = 0.0;
};

/// A point of a body or of ground.
struct End {
  int body = multibody::ground;
  Eigen::Vector3d local = Eigen::Vector3d::Zero();
};

/// An element with its ends.
template <class Element>
struct Between {
  std::string name;
  Element element;
  End a1;
  End a2;
  muscles::ControlInput control = {};
};

struct RigidSystem {
  std::vector<multibody::RigidBody> bodies;
  std::vector<multibody::Pose> poses;
  std::vector<multibody::Joint> joints;
  std::vector<CoordinateForce> joint_forces;
  std::vector<multibody::Load> loads;
  std::vector<Between<muscles::LumpedDea>> muscles;
  std::vector<Between<muscles::Spring>> springs;
  std::vector<muscles::FreeActuator<muscles::LumpedDea>> actuators;  ///< node and dof are filled in by make_model
  std::vector<model::Control> controls;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();
  double length = 100.0;

  int n_bodies() const { return static_cast<int>(bodies.size()); }
  multibody::Pose pose(int body) const {
    return body == multibody::ground ? multibody::Pose{} : poses[static_cast<std::size_t>(body)];
  }
  /// Adds a body with the principal moments `inertia`; returns its index.
  int add_body(double mass, const Eigen::Vector3d& inertia, const multibody::Pose& at);
  /// Adds a joint whose connectors meet in the world point `at` and whose triads are `triad` (world); its index.
  int connect(const multibody::JointPattern& pattern, std::pair<int, int> bodies_a_b, const Eigen::Vector3d& at,
              const Eigen::Matrix3d& triad = Eigen::Matrix3d::Identity());
  /// The body point that lies at a world point in the scene pose.
  End end_at(int body, const Eigen::Vector3d& world) const;
  /// The whole system, its surroundings included, carried along by a rigid motion.
  RigidSystem moved(const multibody::Pose& motion) const;
};

/// The model of a system: bodies, forces of tree joints, of cut joints, loads, muscles, springs, actuators, in this
/// order.
std::unique_ptr<model::Model> make_model(const RigidSystem& system);
/// The same before Model::bind, for parts to add.
std::unique_ptr<model::Model> unbound_model(const RigidSystem& system);
const multibody::TreeManifold& manifold_of(const model::Model& model);

/// The state at t = 0 with coordinates x and minimal velocities w.
variational::State state_at(const model::Model& model, const Eigen::VectorXd& x, const Eigen::VectorXd& w);
/// At rest in the scene pose.
variational::State state_at_rest(const model::Model& model);

/// T(q) as a dense matrix (n_q, n_v).
Eigen::MatrixXd dense_null_space(const multibody::TreeManifold& manifold, const Eigen::VectorXd& x);
/// G(q) of bilinear rows as a dense matrix (rows, n_q).
Eigen::MatrixXd dense_jacobian(std::span<const model::Bilinear> rows, const Eigen::VectorXd& q);
/// q from x.
Eigen::VectorXd configuration_at(const model::Manifold& manifold, const Eigen::VectorXd& x);

}  // namespace muldi::test
