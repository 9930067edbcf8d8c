#pragma once
/// Spanning tree of a multibody system: order of bodies, parents, joints traversed against their direction, loop
/// closers.
#include <string>
#include <vector>

#include "multibody/joint.hpp"

namespace muldi::multibody {

/// How one body hangs in the tree.
struct TreeLink {
  int body = 0;
  int parent = ground;       ///< body, or ground
  int joint = 0;             ///< index into KinematicTree::joints
  bool reversed = false;     ///< the joint's `from` body is the one that hangs on it
  int first_coordinate = 0;  ///< of the joint in x
  int first_rate = 0;        ///< of the joint in the minimal velocities
};

/// One connected part of the system.
struct Chain {
  std::vector<int> bodies = {};  ///< in the order of traversal
  bool anchored = false;
  int n_cut_joints = 0;
};

struct KinematicTree {
  int n_bodies = 0;
  std::vector<Joint> joints;      ///< the user's joints, then one free joint for every chain without anchor
  std::vector<TreeLink> links;    ///< parents before children
  std::vector<int> link_of_body;  ///< (n_bodies)
  std::vector<int> cut_joints;    ///< indices of loop-closing joints
  std::vector<Chain> chains;
  int n_coordinates = 0;
  int n_rates = 0;

  int n_user_joints() const;
  const Joint& joint(const TreeLink& link) const { return joints[static_cast<std::size_t>(link.joint)]; }
  const TreeLink& link_of(int body) const {
    return links[static_cast<std::size_t>(link_of_body[static_cast<std::size_t>(body)])];
  }
};

/// Traverses breadth first from all anchored joints in the user's order, then from the first body of every chain
/// without anchor; bodies, joints and directions may come in any order (thesis 6.3, completed by loops and reversed
/// joints). Joints that would close a loop are cut.
KinematicTree build_tree(int n_bodies, std::vector<Joint> joints);

}  // namespace muldi::multibody
