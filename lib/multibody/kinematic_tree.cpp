#include "multibody/kinematic_tree.hpp"

#include <deque>

#include "base/error.hpp"
#include "multibody/joints/free.hpp"

namespace muldi::multibody {
namespace {

class Traversal {
 public:
  Traversal(int n_bodies, std::vector<Joint> joints)
      : joints_of_body_(static_cast<std::size_t>(n_bodies)), used_(joints.size(), false) {
    tree_.n_bodies = n_bodies;
    tree_.joints = std::move(joints);
    tree_.link_of_body.assign(static_cast<std::size_t>(n_bodies), -1);
    for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
      const Joint& joint = tree_.joints[j];
      MULDI_EXPECT(joint.body_a != joint.body_b, "a joint connects two different bodies");
      for (const int body : {joint.body_a, joint.body_b}) {
        if (body != ground) joints_of_body_[static_cast<std::size_t>(body)].push_back(static_cast<int>(j));
      }
    }
  }

  KinematicTree run() {
    const auto n_user = static_cast<int>(used_.size());
    for (int j = 0; j < n_user; ++j) {
      const Joint& joint = tree_.joints[static_cast<std::size_t>(j)];
      if (used_[static_cast<std::size_t>(j)] || (joint.body_a != ground && joint.body_b != ground)) continue;
      const int body = joint.body_a == ground ? joint.body_b : joint.body_a;
      if (reached(body)) continue;  // a second anchor of a chain closes a loop; `grow` has cut it
      tree_.chains.push_back({.anchored = true});
      grow(body, j, ground);
    }
    for (int body = 0; body < tree_.n_bodies; ++body) {
      if (reached(body)) continue;
      tree_.chains.push_back({.anchored = false});
      tree_.joints.push_back(free_joint(body));
      grow(body, static_cast<int>(tree_.joints.size()) - 1, ground);
    }
    number();
    return std::move(tree_);
  }

 private:
  struct Step {
    int body;
    int joint;
    int parent;
  };

  static Joint free_joint(int body) {
    Joint joint;
    joint.pattern = Free::pattern;
    joint.body_b = body;
    return joint;
  }

  bool reached(int body) const { return tree_.link_of_body[static_cast<std::size_t>(body)] >= 0; }

  void grow(int root, int root_joint, int root_parent) {
    Chain& chain = tree_.chains.back();
    std::deque<Step> waiting{{root, root_joint, root_parent}};
    mark(root_joint);
    while (!waiting.empty()) {
      const Step step = waiting.front();
      waiting.pop_front();
      if (reached(step.body)) {
        tree_.cut_joints.push_back(step.joint);
        ++chain.n_cut_joints;
        continue;
      }
      add_link(step);
      chain.bodies.push_back(step.body);
      for (const int j : joints_of_body_[static_cast<std::size_t>(step.body)]) {
        if (used_[static_cast<std::size_t>(j)]) continue;
        mark(j);
        const Joint& joint = tree_.joints[static_cast<std::size_t>(j)];
        const int other = joint.body_a == step.body ? joint.body_b : joint.body_a;
        if (other == ground) {
          tree_.cut_joints.push_back(j);
          ++chain.n_cut_joints;
        } else {
          waiting.push_back({other, j, step.body});
        }
      }
    }
  }

  void mark(int joint) {
    if (static_cast<std::size_t>(joint) < used_.size()) used_[static_cast<std::size_t>(joint)] = true;
  }

  void add_link(const Step& step) {
    TreeLink link{.body = step.body, .parent = step.parent, .joint = step.joint};
    link.reversed = tree_.joints[static_cast<std::size_t>(step.joint)].body_a == step.body;
    tree_.link_of_body[static_cast<std::size_t>(step.body)] = static_cast<int>(tree_.links.size());
    tree_.links.push_back(link);
  }

  void number() {
    for (TreeLink& link : tree_.links) {
      link.first_coordinate = tree_.n_coordinates;
      link.first_rate = tree_.n_rates;
      tree_.n_coordinates += tree_.joint(link).pattern.n_coordinates();
      tree_.n_rates += tree_.joint(link).pattern.n_rates();
    }
  }

  KinematicTree tree_;
  std::vector<std::vector<int>> joints_of_body_;
  std::vector<bool> used_;
};

}  // namespace

int KinematicTree::n_user_joints() const {
  int n = static_cast<int>(joints.size());
  for (const Chain& chain : chains) n -= chain.anchored ? 0 : 1;
  return n;
}

KinematicTree build_tree(int n_bodies, std::vector<Joint> joints) {
  return Traversal(n_bodies, std::move(joints)).run();
}

}  // namespace muldi::multibody
