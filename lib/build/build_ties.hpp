#pragma once
/// Nodes of solids that are fixed to bodies or to ground, and the forces there.
#include <map>
#include <string>
#include <vector>

#include "build/built_model.hpp"
#include "fem/solid/solid_description.hpp"
#include "multibody/joint.hpp"

namespace muldi::build {

/// Fixes nodes of one solid where they are in the scene pose.
class TieBuilder {
 public:
  /// `data` has its nodes already; all must outlive the object.
  TieBuilder(const scene::Scene& scene, const std::vector<multibody::Pose>& poses, fem::SolidDescription& data)
      : scene_(scene), poses_(poses), data_(data) {}

  /// The body (or multibody::ground) to which the node is fixed; null: to none.
  const int* body_of(int node) const;
  /// Fixes a node that is not fixed yet to a body; its displacement must not be prescribed. Or takes note that ground
  /// holds it, by displacements that the caller prescribes.
  void add(int node, int body);
  std::string name_of(int body) const;

  /// What was fixed, by body in the order of the first node.
  const std::vector<TiedNodes>& groups() const { return groups_; }

 private:
  const scene::Scene& scene_;
  const std::vector<multibody::Pose>& poses_;
  fem::SolidDescription& data_;
  std::map<int, int> body_of_node_;
  std::vector<TiedNodes> groups_;
};

/// What the user should know of nodes that leave a body free to turn: one node is a ball joint, nodes in a line are a
/// hinge; empty for others and for ground. `X`: reference positions of the solid (3 n_nodes).
std::string freedom_note(const Eigen::VectorXd& X, const TiedNodes& group);

/// Force with which a solid acts on what its tied nodes are fixed to, and moment about the body's centre of mass (the
/// origin for ground), world axes.
struct TieWrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
};
TieWrench wrench_on(const fem::Solid& solid, const TiedNodes& group, const model::NodeView& at);

/// ties/<owner>.<body>/force and moment; `solid` and `group` must outlive the observables.
void add_tie_observables(const std::string& owner, const fem::Solid& solid, const TiedNodes& group,
                         model::Model& model);

/// Nodes of one solid that an attachment fixes to another.
struct JoinedNodes {
  std::string name = {};   ///< of the solid
  std::string other = {};  ///< of the one that it is attached to
  std::vector<int> nodes = {};
};

/// ties/<solid>.<other>/force and moment: what the nodes of the solid exert on the other; `solid` must outlive the
/// observables.
void add_joint_observables(const fem::Solid& solid, JoinedNodes joint, model::Model& model);

}  // namespace muldi::build
