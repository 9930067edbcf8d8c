#pragma once
/// Groups of nodes that are eliminated together, and the tree of their dependence (Liu 1990, SIAM J. Matrix Anal. 11).
#include <vector>

#include "math/sparse_ordering.hpp"

namespace muldi::math {

/// Nodes with (nearly) the same neighbours at the time of their elimination: one dense front.
struct Supernode {
  std::vector<int> nodes;  ///< of the graph, in the order of elimination
  int parent = -1;         ///< supernode that takes the update; -1 for a root
  int n_pivots = 0;        ///< unknowns that are eliminated
  int n_rows = 0;          ///< unknowns of the front, the pivots included
};

/// Supernodes, children before parents, and what they cost.
struct SupernodeTree {
  std::vector<Supernode> supernodes;
  double nanoseconds = 0.0;  ///< rough time of one factorisation and a few solves, to compare orders
};

/// Finds the supernodes for an order of elimination; small ones are merged into their parents where the estimated time
/// falls, which stores some zeros. With `limit` > 0: gives up and returns no supernodes once the factor would hold more
/// than `limit` node pairs.
SupernodeTree supernodes(const NodeGraph& graph, const std::vector<int>& order, double limit = 0.0);

/// Node pairs that the factor of a tree holds, roughly.
double n_pairs(const NodeGraph& graph, const SupernodeTree& tree);

}  // namespace muldi::math
