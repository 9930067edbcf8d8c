#include "support/random_tree.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "multibody/registry.hpp"

namespace muldi::test {

using Eigen::Vector3d;
using multibody::ground;

Vector3d random_vector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> in(-size, size);
  const double x = in(random);
  const double y = in(random);
  return {x, y, in(random)};
}

Eigen::Matrix3d random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::Quaterniond rotation;
  for (int k = 0; k < 4; ++k) rotation.coeffs()[k] = normal(random);
  return rotation.normalized().toRotationMatrix();
}

multibody::Pose random_pose(std::mt19937& random, double size) {
  const Vector3d position = random_vector(random, size);
  return {.position = position, .orientation = random_rotation(random)};
}

Eigen::VectorXd random_entries(std::mt19937& random, Eigen::Index n, double size) {
  std::uniform_real_distribution<double> in(-size, size);
  Eigen::VectorXd result(n);
  for (double& entry : result) entry = in(random);
  return result;
}

const std::vector<multibody::JointPattern>& joint_patterns() {
  static const std::vector<multibody::JointPattern> patterns = [] {
    std::vector<multibody::JointPattern> list;
    const auto add_all = [&]<class... Types>(base::TypeList<Types...>) { (list.push_back(Types::pattern), ...); };
    add_all(multibody::JointTypes{});
    return list;
  }();
  return patterns;
}

std::vector<int> random_order(std::mt19937& random, int n) {
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

RigidSystem random_forest(std::mt19937& random, const TreeShape& shape) {
  std::uniform_real_distribution<double> mass(5.0, 60.0);
  std::uniform_real_distribution<double> moment(2.0e3, 3.0e3);
  std::uniform_int_distribution<std::size_t> type(0, joint_patterns().size() - 1);
  std::bernoulli_distribution coin(0.5);
  RigidSystem system;
  system.gravity = random_vector(random, 5e-3);
  std::vector<int> chain_of;
  for (int i = 0; i < shape.n_bodies; ++i) {
    const double m = mass(random);
    const Vector3d inertia(moment(random), moment(random), moment(random));
    const int body = system.add_body(m, inertia, random_pose(random, 100.0));
    const bool root = i < shape.n_chains;
    chain_of.push_back(root ? i : 0);
    int parent = ground;
    if (root && coin(random)) continue;  // free: no joint to ground
    if (!root) {
      parent = std::uniform_int_distribution<int>(0, i - 1)(random);
      chain_of.back() = chain_of[static_cast<std::size_t>(parent)];
    }
    multibody::JointPattern pattern = joint_patterns()[type(random)];
    while (!shape.with_fixed_joints && pattern.n_rates() == 0) pattern = joint_patterns()[type(random)];
    const std::pair<int, int> ends = coin(random) ? std::pair(parent, body) : std::pair(body, parent);
    const Vector3d at = random_vector(random, 100.0);
    system.connect(pattern, ends, at, random_rotation(random));
  }
  return renumbered(system, random_order(random, system.n_bodies()),
                    random_order(random, static_cast<int>(system.joints.size())));
}

RigidSystem renumbered(const RigidSystem& system, const std::vector<int>& bodies, const std::vector<int>& joints) {
  RigidSystem result = system;
  std::vector<int> place(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto from = static_cast<std::size_t>(bodies[i]);
    place[from] = static_cast<int>(i);
    result.bodies[i] = system.bodies[from];
    result.poses[i] = system.poses[from];
  }
  const auto renumber = [&](int body) { return body == ground ? ground : place[static_cast<std::size_t>(body)]; };
  std::vector<int> joint_place(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    joint_place[static_cast<std::size_t>(joints[j])] = static_cast<int>(j);
    multibody::Joint joint = system.joints[static_cast<std::size_t>(joints[j])];
    joint.body_a = renumber(joint.body_a);
    joint.body_b = renumber(joint.body_b);
    result.joints[j] = joint;
  }
  for (auto& force : result.joint_forces) force.joint = joint_place[static_cast<std::size_t>(force.joint)];
  for (auto& load : result.loads) load.body = renumber(load.body);
  for (auto& muscle : result.muscles) {
    muscle.a1.body = renumber(muscle.a1.body);
    muscle.a2.body = renumber(muscle.a2.body);
  }
  for (auto& spring : result.springs) {
    spring.a1.body = renumber(spring.a1.body);
    spring.a2.body = renumber(spring.a2.body);
  }
  return result;
}

Eigen::VectorXd random_coordinates(std::mt19937& random, const model::Manifold& manifold) {
  // rate_scale is 1 for angles and the size of the scene for lengths.
  const Eigen::VectorXd scale = manifold.rate_scale();
  const Eigen::VectorXd w = random_entries(random, manifold.n_v(), 1.0).cwiseProduct(scale.unaryExpr([](double s) {
    return s > 1.0 ? 0.1 * s : s;
  }));
  Eigen::VectorXd x = manifold.reference();
  manifold.retract(manifold.reference(), w, x);
  return x;
}

}  // namespace muldi::test
