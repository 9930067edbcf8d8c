#include "build/build_ties.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>

#include "build/place_bodies.hpp"

namespace muldi::build {
namespace {

/// Index of the body among the hosts of the solid, which it becomes if it is none.
int host_of(int body, const std::string& name, fem::SolidDescription& data) {
  for (std::size_t i = 0; i < data.hosts.size(); ++i) {
    if (data.hosts[i].pattern_node == body) return static_cast<int>(i);
  }
  data.hosts.push_back({.name = name, .pattern_node = body, .first = 12 * static_cast<Eigen::Index>(body)});
  return static_cast<int>(data.hosts.size()) - 1;
}

}  // namespace

const int* TieBuilder::body_of(int node) const {
  const auto found = body_of_node_.find(node);
  return found == body_of_node_.end() ? nullptr : &found->second;
}

std::string TieBuilder::name_of(int body) const {
  return body == multibody::ground ? std::string(scene::ground) : scene_.bodies[static_cast<std::size_t>(body)].name;
}

void TieBuilder::add(int node, int body) {
  body_of_node_.emplace(node, body);
  auto group = std::find_if(groups_.begin(), groups_.end(), [&](const TiedNodes& one) { return one.body == body; });
  if (group == groups_.end()) group = groups_.insert(group, {.body = body, .name = name_of(body)});
  group->nodes.push_back(node);
  if (body == multibody::ground) {
    data_.tied_to_ground = true;
    return;
  }
  const multibody::Pose& pose = poses_[static_cast<std::size_t>(body)];
  const Eigen::Vector3d x = data_.X.segment<3>(3 * static_cast<Eigen::Index>(node));
  data_.ties.push_back({.node = node,
                        .host = host_of(body, group->name, data_),
                        .xi = pose.orientation.transpose() * (x - pose.position)});
}

std::string freedom_note(const Eigen::VectorXd& X, const TiedNodes& group) {
  if (group.body == multibody::ground) return {};
  const auto n = static_cast<Eigen::Index>(group.nodes.size());
  Eigen::Matrix3Xd at(3, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    at.col(k) = X.segment<3>(3 * static_cast<Eigen::Index>(group.nodes[static_cast<std::size_t>(k)]));
  }
  const Eigen::Matrix3Xd apart = at.colwise() - at.rowwise().mean();
  const Eigen::Vector3d squares =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(apart * apart.transpose(), Eigen::EigenvaluesOnly).eigenvalues();
  // The extents of the nodes, ascending; squares are known to round-off of the largest.
  constexpr double flat = 1e-12;
  const std::string fixed = "is fixed to '" + group.name + "' ";
  const std::string firmly = ": choose nodes that are not in one line if it is to hold firmly";
  if (squares[2] <= flat * at.squaredNorm()) return fixed + "at one point, which is a ball joint" + firmly;
  if (squares[1] <= flat * squares[2]) return fixed + "along one line, which is a hinge" + firmly;
  return {};
}

namespace {

/// Of forces on the nodes of a solid, those that these nodes exert on something with its centre there.
TieWrench reaction_to(const Eigen::Ref<const Eigen::VectorXd>& on_nodes, const std::vector<int>& nodes,
                      const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Vector3d& centre) {
  TieWrench wrench;
  for (const int node : nodes) {
    const Eigen::Index first = 3 * static_cast<Eigen::Index>(node);
    const Eigen::Vector3d force = -on_nodes.segment<3>(first);
    const Eigen::Vector3d lever = x.segment<3>(first) - centre;
    wrench.force += force;
    wrench.moment += lever.cross(force);
  }
  return wrench;
}

}  // namespace

TieWrench wrench_on(const fem::Solid& solid, const TiedNodes& group, const model::NodeView& at) {
  // What a tie does to its node, it takes from the body.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  if (group.body != multibody::ground) centre = at.q.segment<3>(12 * static_cast<Eigen::Index>(group.body));
  const auto x = solid.positions(at.q);
  const auto on_nodes = solid.positions(at.constraint_force);
  if (solid.bonds().empty()) return reaction_to(on_nodes, group.nodes, x, centre);
  Eigen::VectorXd accounted = on_nodes;
  solid.bonds().account(3, accounted);
  return reaction_to(accounted, group.nodes, x, centre);
}

namespace {

/// ties/<owner>.<other>/force and moment, by what gives both at a view.
void add_wrench(const std::string& owner, const std::string& other, const std::string& centre,
                const std::function<TieWrench(const model::NodeView&)>& wrench, model::Model& model) {
  const std::string folder = "ties/" + owner + "." + other + "/";
  const auto add = [&](const char* what, base::Dimension unit, const std::string& doc, auto part) {
    model.observables.push_back({.path = folder + what,
                                 .shape = {3},
                                 .unit = unit,
                                 .doc = doc,
                                 .evaluate = [wrench, part](const model::NodeView& at, std::span<double> out) {
                                   const Eigen::Vector3d value = wrench(at).*part;
                                   std::copy(value.data(), value.data() + 3, out.begin());
                                 }});
  };
  add("force", base::dimension::force, "force on " + other + " through its ties, world axes", &TieWrench::force);
  add("moment", base::dimension::torque, "moment on " + other + " through its ties about " + centre + ", world axes",
      &TieWrench::moment);
}

}  // namespace

void add_tie_observables(const std::string& owner, const fem::Solid& solid, const TiedNodes& group,
                         model::Model& model) {
  add_wrench(
      owner, group.name, group.body == multibody::ground ? "the origin" : "its centre of mass",
      [&solid, &group](const model::NodeView& at) { return wrench_on(solid, group, at); }, model);
}

void add_joint_observables(const fem::Solid& solid, JoinedNodes joint, model::Model& model) {
  const std::string owner = joint.name;
  const std::string other = joint.other;
  add_wrench(
      owner, other, "the origin",
      [&solid, joint = std::move(joint)](const model::NodeView& at) {
        Eigen::VectorXd forces = solid.positions(at.constraint_force);
        solid.bonds().forces_of_bonds(forces);
        return reaction_to(forces, joint.nodes, solid.positions(at.q), Eigen::Vector3d::Zero());
      },
      model);
}

}  // namespace muldi::build
