#pragma once
/// Joints of plane faces of two meshes of which neither refines the other. The nodes of the one follow those of the
/// other by mortar conditions
///   int mu_i (x_s - x_m) dA = 0
/// with dual multipliers mu_i (Wohlmuth 2000), so that each node is a sum of others and none is solved for. A constant
/// stress goes through such a joint exactly, which it does not where nodes follow the points that they lie on.
///
/// Corners of the outline stay with the points that they lie on, nodes of its straight sides follow by the same
/// conditions along these, and nodes inside by those on the faces: whatever holds sides or corners of both solids,
/// such as planes of symmetry, is kept. Multipliers of nodes that are placed first go to their neighbours.
#include <Eigen/Core>
#include <set>
#include <vector>

#include "fem/solid/face_overlap.hpp"

namespace muldi::fem {

/// A node that follows others: x = sum_k weights_k x_k, the weights adding up to 1.
struct NodeSum {
  int node = 0;
  std::vector<int> to = {};
  std::vector<double> weights = {};
};

/// The sums of all nodes of `attached` but the corners of its outline and those `placed`, which are in the sums of
/// others as are the nodes of the sides. `X` (3 a node): positions; `others`: faces of the other mesh. Empty where a
/// face of the other mesh holds each of the attached ones whole, so that following points is exact, and where the faces
/// are curved or not wholly on the others, to `tolerance` as in FaceOverlap.
std::vector<NodeSum> mortar_sums(const Eigen::VectorXd& X, const std::vector<FaceNodes>& attached,
                                 const std::vector<FaceNodes>& others, double tolerance,
                                 const std::set<int>& placed = {});

}  // namespace muldi::fem
