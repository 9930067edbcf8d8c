/// The traversal: order, direction, chains, loops; examples of thesis section 6.3.
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "multibody/kinematic_tree.hpp"
#include "multibody/registry.hpp"

namespace muldi::multibody {
namespace {

Joint joint_of(int a, int b, const JointPattern& pattern = Revolute::pattern) {
  Joint joint;
  joint.pattern = pattern;
  joint.body_a = a;
  joint.body_b = b;
  return joint;
}

/// Bodies and joints in the order of traversal.
std::vector<std::pair<int, int>> order_of(const KinematicTree& tree) {
  std::vector<std::pair<int, int>> order;
  for (const TreeLink& link : tree.links) order.emplace_back(link.joint, link.body);
  return order;
}
using Order = std::vector<std::pair<int, int>>;

TEST(KinematicTree, TraversesTheThesisTree) {
  // Figure 6.6: joint 0 from body 0 to 1, joint 1 from 1 to 2, joint 2 from 1 to 3 (equations 6.12 to 6.14).
  const KinematicTree tree = build_tree(4, {joint_of(0, 1), joint_of(1, 2), joint_of(1, 3)});
  EXPECT_EQ(order_of(tree), (Order{{3, 0}, {0, 1}, {1, 2}, {2, 3}})) << "joint 3 is the free root";
  EXPECT_EQ(tree.n_rates, 6 + 3);
  EXPECT_EQ(tree.n_coordinates, 7 + 3);
  ASSERT_EQ(tree.chains.size(), 1u);
  EXPECT_FALSE(tree.chains[0].anchored);
  EXPECT_EQ(tree.n_user_joints(), 3);
  for (const TreeLink& link : tree.links) EXPECT_FALSE(link.reversed);
}

TEST(KinematicTree, TraversesTheThesisUnorderedAnchoredChain) {
  // Figure 6.7, table 6.1: joint 0 from body 1 to 0, joint 1 from 1 to 2, joint 2 from ground to 1. The thesis takes
  // joints 2, 1, 0 (its stack is last in, first out); breadth first the branches come in the user's order.
  const KinematicTree tree = build_tree(3, {joint_of(1, 0), joint_of(1, 2), joint_of(ground, 1)});
  EXPECT_EQ(order_of(tree), (Order{{2, 1}, {0, 0}, {1, 2}}));
  EXPECT_EQ(tree.link_of(0).parent, 1);
  EXPECT_EQ(tree.link_of(2).parent, 1);
  EXPECT_EQ(tree.link_of(1).parent, ground);
  EXPECT_TRUE(tree.chains[0].anchored);
  EXPECT_EQ(tree.n_rates, 3);
}

TEST(KinematicTree, MarksJointsThatAreMetFromTheirOtherEnd) {
  const KinematicTree tree = build_tree(3, {joint_of(0, ground), joint_of(1, 0), joint_of(1, 2)});
  EXPECT_TRUE(tree.link_of(0).reversed);
  EXPECT_TRUE(tree.link_of(1).reversed);
  EXPECT_FALSE(tree.link_of(2).reversed);
}

TEST(KinematicTree, KeepsChainsApartAnchoredOnesFirst) {
  const KinematicTree tree =
      build_tree(6, {joint_of(0, 3), joint_of(2, 5), joint_of(ground, 5, Prismatic::pattern), joint_of(4, ground)});
  ASSERT_EQ(tree.chains.size(), 4u);
  EXPECT_EQ(tree.chains[0].bodies, (std::vector<int>{5, 2}));
  EXPECT_EQ(tree.chains[1].bodies, (std::vector<int>{4}));
  EXPECT_EQ(tree.chains[2].bodies, (std::vector<int>{0, 3}));
  EXPECT_EQ(tree.chains[3].bodies, (std::vector<int>{1}));
  EXPECT_TRUE(tree.chains[0].anchored && tree.chains[1].anchored);
  EXPECT_FALSE(tree.chains[2].anchored || tree.chains[3].anchored);
  EXPECT_EQ(tree.n_rates, 2 + 1 + 7 + 6);
  EXPECT_EQ(tree.n_user_joints(), 4);
}

TEST(KinematicTree, CutsWhatClosesALoop) {
  // A four-bar; breadth first from the first anchor, the loop is cut opposite to it or at the second anchor.
  const KinematicTree tree = build_tree(3, {joint_of(ground, 0), joint_of(0, 1), joint_of(1, 2), joint_of(2, ground)});
  EXPECT_EQ(tree.cut_joints.size(), 1u);
  EXPECT_EQ(tree.links.size(), 3u);
  EXPECT_EQ(tree.chains.size(), 1u);
  EXPECT_EQ(tree.chains[0].n_cut_joints, 1);
}

TEST(KinematicTree, CutsTheSecondOfTwoJointsBetweenTheSameBodies) {
  const KinematicTree tree = build_tree(2, {joint_of(ground, 0), joint_of(0, 1), joint_of(1, 0)});
  EXPECT_EQ(tree.cut_joints, (std::vector<int>{2}));
}

TEST(KinematicTree, CutsASecondAnchorOfOneBody) {
  const KinematicTree tree = build_tree(1, {joint_of(ground, 0), joint_of(0, ground)});
  EXPECT_EQ(tree.cut_joints, (std::vector<int>{1}));
  EXPECT_EQ(tree.chains.size(), 1u);
}

TEST(KinematicTree, NumbersCoordinatesInTheOrderOfTraversal) {
  const KinematicTree tree = build_tree(
      3, {joint_of(0, 1, Spherical::pattern), joint_of(ground, 0, Planar::pattern), joint_of(1, 2, Fixed::pattern)});
  EXPECT_EQ(tree.link_of(0).first_coordinate, 0);
  EXPECT_EQ(tree.link_of(1).first_coordinate, 3);
  EXPECT_EQ(tree.link_of(2).first_coordinate, 7);
  EXPECT_EQ(tree.link_of(2).first_rate, 6);
  EXPECT_EQ(tree.n_coordinates, 7);
  EXPECT_EQ(tree.n_rates, 6);
}

TEST(KinematicTree, RefusesAJointOfABodyToItself) {
  EXPECT_THROW(static_cast<void>(build_tree(1, {joint_of(0, 0)})), base::ContractError);
}

TEST(KinematicTree, OfNothingIsEmpty) {
  const KinematicTree tree = build_tree(0, {});
  EXPECT_EQ(tree.links.size(), 0u);
  EXPECT_EQ(tree.n_rates, 0);
}

}  // namespace
}  // namespace muldi::multibody
