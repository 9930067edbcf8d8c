#include "support/rigid_system.hpp"

#include <algorithm>

#include "variational/node_values.hpp"

namespace muldi::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

model::LinearPoint point_of(const End& end) { return multibody::body_point(end.body, end.local); }

void add_joint_forces(const RigidSystem& system, const multibody::KinematicTree& tree, model::Model& model) {
  std::vector<multibody::TreeJointForce> forces;
  std::vector<multibody::CutJointForce> cut_forces;
  for (const CoordinateForce& force : system.joint_forces) {
    const multibody::Joint& joint = tree.joints[static_cast<std::size_t>(force.joint)];
    const multibody::JointForce law{.part = "joints/" + joint.name,
                                    .stiffness = force.stiffness,
                                    .rest = force.rest,
                                    .damping = force.damping,
                                    .stops = force.stops,
                                    .control = force.control,
                                    .control_factor = force.control_factor,
                                    .constant = force.constant};
    const auto link = std::find_if(tree.links.begin(), tree.links.end(),
                                   [&](const multibody::TreeLink& of) { return of.joint == force.joint; });
    if (link == tree.links.end()) {
      cut_forces.push_back({law, {joint, joint.pattern.motions[force.motion]}});
      continue;
    }
    multibody::TreeJointForce in_tree{law, link->first_coordinate, link->first_rate};
    for (std::size_t k = 0; k < force.motion; ++k) {
      in_tree.coordinate += joint.pattern.motions[k].n_coordinates();
      in_tree.rate += joint.pattern.motions[k].n_rates();
    }
    forces.push_back(in_tree);
  }
  if (!forces.empty()) model.terms.push_back(std::make_unique<multibody::JointForces>(std::move(forces)));
  if (!cut_forces.empty()) model.terms.push_back(std::make_unique<multibody::CutJointForces>(std::move(cut_forces)));
}

template <class Element>
void add_elements(const std::vector<Between<Element>>& elements, const Vector3d& gravity, model::Model& model) {
  if (elements.empty()) return;
  std::vector<muscles::TwoPointComponent<Element>> components;
  for (const Between<Element>& element : elements) {
    muscles::TwoPointComponent<Element> component{element.name, element.element, point_of(element.a1),
                                                  point_of(element.a2)};
    if constexpr (Element::n_controls == 1) component.controls[0] = element.control;
    components.push_back(component);
  }
  model.terms.push_back(std::make_unique<muscles::TwoPointTerm<Element>>(std::move(components), gravity));
}

}  // namespace

int RigidSystem::add_body(double mass, const Vector3d& inertia, const multibody::Pose& at) {
  bodies.push_back({.name = "body" + std::to_string(bodies.size()), .mass = mass, .inertia = inertia.asDiagonal()});
  poses.push_back(at);
  return n_bodies() - 1;
}

End RigidSystem::end_at(int body, const Vector3d& world) const {
  const multibody::Pose at = pose(body);
  return {body, at.orientation.transpose() * (world - at.position)};
}

int RigidSystem::connect(const multibody::JointPattern& pattern, std::pair<int, int> bodies_a_b, const Vector3d& at,
                         const Matrix3d& triad) {
  multibody::Joint joint;
  joint.name = "joint" + std::to_string(joints.size());
  joint.pattern = pattern;
  joint.body_a = bodies_a_b.first;
  joint.body_b = bodies_a_b.second;
  joint.rho_a = end_at(joint.body_a, at).local;
  joint.rho_b = end_at(joint.body_b, at).local;
  joint.align(pose(joint.body_a), pose(joint.body_b), triad);
  joints.push_back(joint);
  return static_cast<int>(joints.size()) - 1;
}

RigidSystem RigidSystem::moved(const multibody::Pose& motion) const {
  RigidSystem result = *this;
  const Matrix3d& R = motion.orientation;
  for (multibody::Pose& pose : result.poses) pose = {motion.point(pose.position), R * pose.orientation};
  for (multibody::Joint& joint : result.joints) {
    if (joint.body_a == multibody::ground) {
      joint.rho_a = motion.point(joint.rho_a);
      joint.triad_a = R * joint.triad_a;
    }
    if (joint.body_b == multibody::ground) {
      joint.rho_b = motion.point(joint.rho_b);
      joint.triad_b = R * joint.triad_b;
    }
  }
  for (multibody::Load& load : result.loads) {
    if (load.frame == multibody::Load::Frame::world) load.direction = R * load.direction;
  }
  const auto carry = [&](auto& elements) {
    for (auto& element : elements) {
      for (End* end : {&element.a1, &element.a2}) {
        if (end->body == multibody::ground) end->local = motion.point(end->local);
      }
    }
  };
  carry(result.muscles);
  carry(result.springs);
  result.gravity = R * gravity;
  return result;
}

std::unique_ptr<model::Model> unbound_model(const RigidSystem& system) {
  auto model = std::make_unique<model::Model>();
  multibody::KinematicTree tree = multibody::build_tree(system.n_bodies(), system.joints);
  model->node_sizes.assign(static_cast<std::size_t>(system.n_bodies()), 12);
  model->controls = system.controls;
  if (system.n_bodies() > 0) {
    model->terms.push_back(std::make_unique<multibody::RigidBodies>(system.bodies, system.gravity));
  }
  add_joint_forces(system, tree, *model);
  if (!system.loads.empty()) model->terms.push_back(std::make_unique<multibody::Loads>(system.loads));
  add_elements(system.muscles, system.gravity, *model);
  add_elements(system.springs, system.gravity, *model);
  std::vector<double> plain;
  auto actuators = system.actuators;
  for (auto& actuator : actuators) {
    actuator.node = static_cast<int>(model->node_sizes.size());
    actuator.dof = 12 * system.n_bodies() + static_cast<int>(plain.size());
    model->node_sizes.push_back(1);
    plain.push_back(actuator.element.length);
  }
  if (!actuators.empty()) {
    model->terms.push_back(std::make_unique<muscles::FreeActuatorTerm<muscles::LumpedDea>>(actuators));
  }
  model->manifold =
      std::make_unique<multibody::TreeManifold>(std::move(tree), system.poses, std::move(plain), system.length);
  return model;
}

std::unique_ptr<model::Model> make_model(const RigidSystem& system) {
  auto model = unbound_model(system);
  model->bind();
  return model;
}

const multibody::TreeManifold& manifold_of(const model::Model& model) {
  return dynamic_cast<const multibody::TreeManifold&>(*model.manifold);
}

VectorXd configuration_at(const model::Manifold& manifold, const VectorXd& x) {
  VectorXd q = VectorXd::Zero(manifold.n_q());
  manifold.configuration(x, q);
  return q;
}

variational::State state_at(const model::Model& model, const VectorXd& x, const VectorXd& w) {
  const model::Manifold& manifold = *model.manifold;
  variational::State state;
  state.x = x;
  state.q = configuration_at(manifold, x);
  const auto frame = manifold.make_frame();
  manifold.update(state.x, state.q, *frame);
  VectorXd v = VectorXd::Zero(manifold.n_q());
  manifold.lift(*frame, w, v);
  std::vector<double> u(model.controls.size());
  model.evaluate_controls(0.0, u);
  state.p = v;
  variational::NodeEvaluator(model, "auto").momentum_of(state.q, v, u, state.p);
  state.increment = VectorXd::Zero(manifold.n_v());
  state.multipliers = VectorXd::Zero(manifold.n_loop_rows());
  return state;
}

variational::State state_at_rest(const model::Model& model) {
  return state_at(model, model.manifold->reference(), VectorXd::Zero(model.manifold->n_v()));
}

Eigen::MatrixXd dense_null_space(const multibody::TreeManifold& manifold, const VectorXd& x) {
  const VectorXd q = configuration_at(manifold, x);
  const auto frame = manifold.make_frame();
  manifold.update(x, q, *frame);
  Eigen::MatrixXd T(manifold.n_q(), manifold.n_v());
  VectorXd dq = VectorXd::Zero(manifold.n_q());
  for (int k = 0; k < manifold.n_v(); ++k) {
    manifold.lift(*frame, VectorXd::Unit(manifold.n_v(), k), dq);
    T.col(k) = dq;
  }
  return T;
}

Eigen::MatrixXd dense_jacobian(std::span<const model::Bilinear> rows, const VectorXd& q) {
  Eigen::MatrixXd G(static_cast<Eigen::Index>(rows.size()), q.size());
  VectorXd gradient(q.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    gradient.setZero();
    rows[i].add_gradient(q, 1.0, gradient);
    G.row(static_cast<Eigen::Index>(i)) = gradient.transpose();
  }
  return G;
}

}  // namespace muldi::test
