#pragma once
/// How much each node of a tied solid follows each of its anchors: the bodies that it is tied to, and ground last where
/// ground holds nodes. Weights go by the inverse reference distance to the nodes of the anchor, so that a tied node
/// follows its body alone, and a held one ground.
#include <Eigen/Core>
#include <vector>

#include "fem/solid/solid_description.hpp"

namespace muldi::fem {

struct TieWeights {
  std::vector<Eigen::VectorXd> weights = {};  ///< (n_anchors), one for each group of nodes that have the same
  std::vector<int> group_of_node = {};        ///< empty for a solid that is tied to no body
  std::size_t n_anchors = 0;

  explicit TieWeights(const SolidDescription& data);

  const Eigen::VectorXd& of_node(std::size_t node) const {
    return weights[static_cast<std::size_t>(group_of_node[node])];
  }
};

}  // namespace muldi::fem
