#pragma once
/// Orders in which the nodes of a graph are eliminated.
#include <cstddef>
#include <string_view>
#include <vector>

namespace muldi::math {

/// How the nodes are ordered for elimination.
enum class Ordering {
  automatic,         ///< the one of the others with the least estimated time
  natural,           ///< as numbered: best for slender meshes numbered layer by layer
  minimum_degree,    ///< AMD of SuiteSparse
  nested_dissection  ///< METIS: best for three-dimensional meshes
};

/// The name of the enumerator.
std::string_view name_of(Ordering ordering);

/// An undirected graph with weights, by neighbour lists (both directions, no loops).
struct NodeGraph {
  std::vector<int> start;       ///< (n + 1)
  std::vector<int> neighbours;  ///< ascending for each node
  std::vector<int> weights;     ///< (n) unknowns a node, >= 1

  int n_nodes() const { return static_cast<int>(weights.size()); }
};

/// The node that is eliminated i-th, for every i; not for `automatic`.
std::vector<int> elimination_order(const NodeGraph& graph, Ordering ordering);

}  // namespace muldi::math
