#include "math/sparse_supernodes.hpp"

#include <algorithm>
#include <numeric>

namespace muldi::math {
namespace {

using Index = std::size_t;

std::vector<int> inverse_of(const std::vector<int>& order) {
  std::vector<int> position(order.size());
  for (Index i = 0; i < order.size(); ++i) position[static_cast<Index>(order[i])] = static_cast<int>(i);
  return position;
}

/// Parent of every position in the elimination tree, with path compression.
std::vector<int> elimination_tree(const NodeGraph& graph, const std::vector<int>& order) {
  const std::vector<int> position = inverse_of(order);
  std::vector<int> parent(order.size(), -1);
  std::vector<int> ancestor(order.size(), -1);
  for (Index i = 0; i < order.size(); ++i) {
    const Index node = static_cast<Index>(order[i]);
    for (int e = graph.start[node]; e < graph.start[node + 1]; ++e) {
      int k = position[static_cast<Index>(graph.neighbours[static_cast<Index>(e)])];
      while (k >= 0 && k < static_cast<int>(i)) {
        const int next = ancestor[static_cast<Index>(k)];
        ancestor[static_cast<Index>(k)] = static_cast<int>(i);
        if (next < 0) parent[static_cast<Index>(k)] = static_cast<int>(i);
        k = next;
      }
    }
  }
  return parent;
}

/// Children of every vertex, in ascending order, as lists.
struct ChildLists {
  std::vector<int> first;
  std::vector<int> next;
};

ChildLists child_lists(const std::vector<int>& parent) {
  ChildLists lists{std::vector<int>(parent.size(), -1), std::vector<int>(parent.size(), -1)};
  for (Index i = parent.size(); i-- > 0;) {
    if (parent[i] < 0) continue;
    lists.next[i] = lists.first[static_cast<Index>(parent[i])];
    lists.first[static_cast<Index>(parent[i])] = static_cast<int>(i);
  }
  return lists;
}

/// The vertices of a forest, children before parents, every subtree in one piece.
std::vector<int> postorder(const std::vector<int>& parent) {
  ChildLists lists = child_lists(parent);
  std::vector<int> result;
  result.reserve(parent.size());
  std::vector<int> path;
  for (Index root = 0; root < parent.size(); ++root) {
    if (parent[root] >= 0) continue;
    path.push_back(static_cast<int>(root));
    while (!path.empty()) {
      const Index top = static_cast<Index>(path.back());
      const int child = lists.first[top];
      if (child < 0) {
        result.push_back(path.back());
        path.pop_back();
      } else {
        lists.first[top] = lists.next[static_cast<Index>(child)];
        path.push_back(child);
      }
    }
  }
  return result;
}

/// For every position the nodes and the unknowns of its column of the factor, the diagonal included. Row i of the
/// factor is the part of the tree between the neighbours of i and i.
struct ColumnCounts {
  std::vector<int> nodes;
  std::vector<int> unknowns;
  bool within_limit = true;
};

ColumnCounts column_counts(const NodeGraph& graph, const std::vector<int>& order, const std::vector<int>& parent,
                           double limit) {
  const std::vector<int> position = inverse_of(order);
  ColumnCounts counts{std::vector<int>(order.size(), 1), std::vector<int>(order.size(), 0)};
  std::vector<int> mark(order.size(), -1);
  double total = 0.0;
  for (Index i = 0; i < order.size(); ++i) {
    const Index node = static_cast<Index>(order[i]);
    const int weight = graph.weights[node];
    counts.unknowns[i] += weight;
    mark[i] = static_cast<int>(i);
    for (int e = graph.start[node]; e < graph.start[node + 1]; ++e) {
      int k = position[static_cast<Index>(graph.neighbours[static_cast<Index>(e)])];
      if (k > static_cast<int>(i)) continue;
      for (; mark[static_cast<Index>(k)] != static_cast<int>(i); k = parent[static_cast<Index>(k)]) {
        mark[static_cast<Index>(k)] = static_cast<int>(i);
        ++counts.nodes[static_cast<Index>(k)];
        counts.unknowns[static_cast<Index>(k)] += weight;
        total += 1.0;
      }
    }
    if (limit > 0.0 && total > limit) {
      counts.within_limit = false;
      return counts;
    }
  }
  return counts;
}

/// Time of a front in ns on a 2020s core: products, and passes over panel and update (zeroing, assembly, solves).
double front_time(int n_pivots, int n_rows) {
  const double k = n_pivots;
  const double m = n_rows;
  const double r = m - k;
  const double products = k * k * k / 6.0 + k * k * r / 2.0 + k * r * r / 2.0;
  return 400.0 + products / 12.0 + 1.2 * k * (m - k / 2.0) + 0.5 * r * r;
}

/// Supernodes whose columns have the same rows, positions in post-order.
SupernodeTree exact_supernodes(const NodeGraph& graph, const std::vector<int>& order, const std::vector<int>& parent,
                               const ColumnCounts& counts) {
  SupernodeTree tree;
  std::vector<int> owner(order.size());
  for (Index i = 0; i < order.size(); ++i) {
    const bool continues = i > 0 && parent[i - 1] == static_cast<int>(i) && counts.nodes[i - 1] == counts.nodes[i] + 1;
    if (!continues) {
      tree.supernodes.emplace_back();
      tree.supernodes.back().n_rows = counts.unknowns[i];
    }
    Supernode& last = tree.supernodes.back();
    last.nodes.push_back(order[i]);
    last.n_pivots += graph.weights[static_cast<Index>(order[i])];
    last.parent = parent[i];  // a position; of the last node
    owner[i] = static_cast<int>(tree.supernodes.size()) - 1;
  }
  for (Supernode& s : tree.supernodes) {
    if (s.parent >= 0) s.parent = owner[static_cast<Index>(s.parent)];
  }
  return tree;
}

/// Merges children into parents while that saves time; merged ones are left empty.
void merge_children(std::vector<Supernode>& all) {
  std::vector<std::vector<int>> children(all.size());
  for (Index s = 0; s < all.size(); ++s) {
    if (all[s].parent >= 0) children[static_cast<Index>(all[s].parent)].push_back(static_cast<int>(s));
  }
  for (Index p = 0; p < all.size(); ++p) {
    Supernode& parent = all[p];
    // The last child's update fills most of the parent; the list grows by the children of merged ones.
    for (bool merged = true; merged;) {
      merged = false;
      for (Index c = children[p].size(); c-- > 0;) {
        const Index child = static_cast<Index>(children[p][c]);
        Supernode& candidate = all[child];
        const double apart =
            front_time(candidate.n_pivots, candidate.n_rows) + front_time(parent.n_pivots, parent.n_rows);
        const double together = front_time(candidate.n_pivots + parent.n_pivots, candidate.n_pivots + parent.n_rows);
        if (together > apart) continue;
        candidate.nodes.insert(candidate.nodes.end(), parent.nodes.begin(), parent.nodes.end());
        parent.nodes = std::move(candidate.nodes);
        candidate.nodes.clear();
        parent.n_pivots += candidate.n_pivots;
        parent.n_rows += candidate.n_pivots;
        children[p].erase(children[p].begin() + static_cast<std::ptrdiff_t>(c));
        for (const int grandchild : children[child]) {
          all[static_cast<Index>(grandchild)].parent = static_cast<int>(p);
          children[p].push_back(grandchild);
        }
        merged = true;
      }
    }
  }
}

/// Drops the empty ones and orders the rest so that every subtree is in one piece.
SupernodeTree compacted(std::vector<Supernode> all) {
  std::vector<int> kept(all.size(), -1);
  std::vector<int> parent;
  std::vector<Index> from;
  for (Index s = 0; s < all.size(); ++s) {
    if (all[s].nodes.empty()) continue;
    kept[s] = static_cast<int>(from.size());
    from.push_back(s);
  }
  parent.reserve(from.size());
  for (const Index s : from) parent.push_back(all[s].parent < 0 ? -1 : kept[static_cast<Index>(all[s].parent)]);
  const std::vector<int> order = postorder(parent);
  const std::vector<int> position = inverse_of(order);
  SupernodeTree tree;
  for (const int s : order) {
    Supernode next = std::move(all[from[static_cast<Index>(s)]]);
    const int up = parent[static_cast<Index>(s)];
    next.parent = up < 0 ? -1 : position[static_cast<Index>(up)];
    tree.nanoseconds += front_time(next.n_pivots, next.n_rows);
    tree.supernodes.push_back(std::move(next));
  }
  return tree;
}

}  // namespace

SupernodeTree supernodes(const NodeGraph& graph, const std::vector<int>& order, double limit) {
  // The tree's post-order eliminates with the same fill and puts nodes of one supernode side by side.
  const std::vector<int> unsorted_parent = elimination_tree(graph, order);
  std::vector<int> sorted = postorder(unsorted_parent);
  const std::vector<int> position = inverse_of(sorted);
  std::vector<int> parent(order.size(), -1);
  for (Index i = 0; i < order.size(); ++i) {
    const int up = unsorted_parent[static_cast<Index>(sorted[i])];
    if (up >= 0) parent[i] = position[static_cast<Index>(up)];
  }
  for (int& place : sorted) place = order[static_cast<Index>(place)];
  const ColumnCounts counts = column_counts(graph, sorted, parent, limit);
  if (!counts.within_limit) return {};
  SupernodeTree exact = exact_supernodes(graph, sorted, parent, counts);
  merge_children(exact.supernodes);
  return compacted(std::move(exact.supernodes));
}

double n_pairs(const NodeGraph& graph, const SupernodeTree& tree) {
  double entries = 0.0;
  for (const Supernode& s : tree.supernodes) entries += static_cast<double>(s.n_pivots) * (s.n_rows - s.n_pivots / 2.0);
  const double weight = std::accumulate(graph.weights.begin(), graph.weights.end(), 0.0) / graph.n_nodes();
  return entries / (weight * weight);
}

}  // namespace muldi::math
