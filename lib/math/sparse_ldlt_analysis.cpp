#include "math/sparse_ldlt_analysis.hpp"

#include <algorithm>
#include <bit>

#include "base/error.hpp"
#include "math/sparse_kernels.hpp"
#include "math/sparse_supernodes.hpp"

namespace muldi::math {
namespace {

using Index = std::size_t;

int padded(int rows) { return (rows + kernels::row_multiple - 1) / kernels::row_multiple * kernels::row_multiple; }

/// The nodes with free unknowns, as a graph.
struct FreeNodes {
  NodeGraph graph;
  std::vector<int> node;  // of the pattern, for each node of the graph
};

FreeNodes free_nodes(const SymmetricBlockPattern& pattern, const NodeMask& mask) {
  FreeNodes result;
  const int b = pattern.block_size();
  const unsigned all = (1u << b) - 1u;
  std::vector<int> number(mask.size(), -1);
  for (Index i = 0; i < mask.size(); ++i) {
    const int weight = b - std::popcount(mask[i] & all);
    if (weight == 0) continue;
    number[i] = static_cast<int>(result.node.size());
    result.node.push_back(static_cast<int>(i));
    result.graph.weights.push_back(weight);
  }
  std::vector<int>& start = result.graph.start;
  start.assign(result.node.size() + 1, 0);
  const auto for_each_edge = [&](auto&& visit) {
    for (Index i = 0; i < mask.size(); ++i) {
      for (int slot = pattern.row_start()[i] + 1; slot < pattern.row_start()[i + 1]; ++slot) {
        const int other = number[static_cast<Index>(pattern.columns()[static_cast<Index>(slot)])];
        if (number[i] >= 0 && other >= 0) visit(static_cast<Index>(number[i]), static_cast<Index>(other));
      }
    }
  };
  for_each_edge([&](Index i, Index j) { ++start[i + 1], ++start[j + 1]; });
  for (Index i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  result.graph.neighbours.resize(static_cast<Index>(start.back()));
  std::vector<int> next(start.begin(), start.end() - 1);
  // Rows ascend, so every list gets its lower neighbours first and in order.
  for_each_edge(
      [&](Index i, Index j) { result.graph.neighbours[static_cast<Index>(next[j]++)] = static_cast<int>(i); });
  for_each_edge(
      [&](Index i, Index j) { result.graph.neighbours[static_cast<Index>(next[i]++)] = static_cast<int>(j); });
  return result;
}

struct Choice {
  SupernodeTree tree;
  Ordering ordering = Ordering::natural;
};

Choice choose(const NodeGraph& graph, Ordering wanted) {
  if (wanted != Ordering::automatic) return {supernodes(graph, elimination_order(graph, wanted)), wanted};
  Choice best{{}, Ordering::minimum_degree};
  best.tree = supernodes(graph, elimination_order(graph, Ordering::minimum_degree));
  for (const Ordering other : {Ordering::nested_dissection, Ordering::natural}) {
    // An order with four times the fill cannot win; finding out how bad it is could take long.
    SupernodeTree tree = supernodes(graph, elimination_order(graph, other), 4.0 * n_pairs(graph, best.tree) + 1e4);
    if (tree.supernodes.empty() || tree.nanoseconds >= best.tree.nanoseconds) continue;
    best = {std::move(tree), other};
  }
  return best;
}

}  // namespace

/// Fills an analysis from the chosen supernodes.
struct LdltAnalysis::Builder {
  LdltAnalysis& to;
  const SymmetricBlockPattern& pattern;
  const FreeNodes& nodes;
  const SupernodeTree& tree;
  std::vector<int> position;            // order of elimination of the graph's nodes
  std::vector<int> node_at;             // its inverse
  std::vector<int> unknown_at;          // first unknown of each position; one more at the end
  std::vector<int> front_of;            // front that eliminates each position
  std::vector<std::vector<int>> below;  // positions of the rows below the pivots, ascending, of each front

  void number() {
    position.resize(nodes.node.size());
    for (Index f = 0; f < tree.supernodes.size(); ++f) {
      for (const int node : tree.supernodes[f].nodes) {
        position[static_cast<Index>(node)] = static_cast<int>(node_at.size());
        node_at.push_back(node);
        unknown_at.push_back(static_cast<int>(to.unknowns_.size()));
        front_of.push_back(static_cast<int>(f));
        add_unknowns(nodes.node[static_cast<Index>(node)]);
      }
    }
    unknown_at.push_back(static_cast<int>(to.unknowns_.size()));
  }

  void add_unknowns(int node) {
    for (int c = 0; c < to.block_size_; ++c) {
      if (((to.mask_[static_cast<Index>(node)] >> c) & 1) == 0) to.unknowns_.push_back(node * to.block_size_ + c);
    }
  }

  void add_fronts() {
    for (const Supernode& s : tree.supernodes) {
      Front front;
      front.first = unknown_at[static_cast<Index>(position[static_cast<Index>(s.nodes.front())])];
      front.n_pivots = s.n_pivots;
      front.n_rows = s.n_rows;
      front.stride = padded(s.n_rows);
      front.parent = s.parent;
      to.fronts_.push_back(front);
    }
    std::vector<std::vector<int>> children(to.fronts_.size());
    for (Index f = 0; f < to.fronts_.size(); ++f) {
      if (to.fronts_[f].parent >= 0) children[static_cast<Index>(to.fronts_[f].parent)].push_back(static_cast<int>(f));
    }
    for (Index f = 0; f < to.fronts_.size(); ++f) {
      to.fronts_[f].children[0] = static_cast<int>(to.children_.size());
      to.children_.insert(to.children_.end(), children[f].begin(), children[f].end());
      to.fronts_[f].children[1] = static_cast<int>(to.children_.size());
    }
  }

  /// Rows of a front: the later neighbours of its nodes and the rows of its children, without its own nodes.
  void find_rows() {
    below.resize(to.fronts_.size());
    std::vector<int> mark(node_at.size(), -1);
    for (Index f = 0; f < to.fronts_.size(); ++f) {
      std::vector<int>& rows = below[f];
      const auto take = [&](int p) {
        if (front_of[static_cast<Index>(p)] <= static_cast<int>(f) ||
            mark[static_cast<Index>(p)] == static_cast<int>(f))
          return;
        mark[static_cast<Index>(p)] = static_cast<int>(f);
        rows.push_back(p);
      };
      for (const int node : tree.supernodes[f].nodes) {
        const Index n = static_cast<Index>(node);
        for (int e = nodes.graph.start[n]; e < nodes.graph.start[n + 1]; ++e) {
          take(position[static_cast<Index>(nodes.graph.neighbours[static_cast<Index>(e)])]);
        }
      }
      for (int c = to.fronts_[f].children[0]; c < to.fronts_[f].children[1]; ++c) {
        for (const int p : below[static_cast<Index>(to.children_[static_cast<Index>(c)])]) take(p);
      }
      std::sort(rows.begin(), rows.end());
      add_row_runs(f);
    }
  }

  int weight(int p) const { return unknown_at[static_cast<Index>(p) + 1] - unknown_at[static_cast<Index>(p)]; }

  void add_row_runs(Index f) {
    Front& front = to.fronts_[f];
    front.rows[0] = static_cast<int>(to.row_runs_.size());
    int row = front.n_pivots;
    for (const int p : below[f]) {
      const int unknown = unknown_at[static_cast<Index>(p)];
      const bool continues = static_cast<int>(to.row_runs_.size()) > front.rows[0] &&
                             to.row_runs_.back().from + to.row_runs_.back().length == unknown;
      if (!continues) to.row_runs_.push_back({unknown, row, 0});
      to.row_runs_.back().length += weight(p);
      row += weight(p);
    }
    front.rows[1] = static_cast<int>(to.row_runs_.size());
    MULDI_EXPECT(row == front.n_rows, "the supernodes' sizes are those of their fronts");
  }

  /// Calls visit(position, row in the front) for every node of a front.
  template <class Visit>
  void for_each_row(Index f, Visit&& visit) const {
    int row = 0;
    for (const int node : tree.supernodes[f].nodes) {
      const int p = position[static_cast<Index>(node)];
      visit(p, row);
      row += weight(p);
    }
    for (const int p : below[f]) {
      visit(p, row);
      row += weight(p);
    }
  }

  void add_maps_and_entries() {
    std::vector<int> row_of(node_at.size(), 0);
    std::vector<std::vector<Run>> maps(to.fronts_.size());
    for (Index f = 0; f < to.fronts_.size(); ++f) {
      for_each_row(f, [&](int p, int row) { row_of[static_cast<Index>(p)] = row; });
      for (int c = to.fronts_[f].children[0]; c < to.fronts_[f].children[1]; ++c) {
        const Index child = static_cast<Index>(to.children_[static_cast<Index>(c)]);
        maps[child] = child_map(child, to.fronts_[f].n_pivots, row_of);
      }
      add_entries(f, row_of);
    }
    for (Index f = 0; f < to.fronts_.size(); ++f) {
      to.fronts_[f].map[0] = static_cast<int>(to.map_runs_.size());
      to.map_runs_.insert(to.map_runs_.end(), maps[f].begin(), maps[f].end());
      to.fronts_[f].map[1] = static_cast<int>(to.map_runs_.size());
    }
  }

  /// No run crosses the last pivot of the parent.
  std::vector<Run> child_map(Index child, int parent_pivots, const std::vector<int>& row_of) const {
    std::vector<Run> runs;
    int row = to.fronts_[child].n_pivots;
    for (const int p : below[child]) {
      const int target = row_of[static_cast<Index>(p)];
      const bool continues = !runs.empty() && runs.back().to + runs.back().length == target && target != parent_pivots;
      if (!continues) runs.push_back({row, target, 0});
      runs.back().length += weight(p);
      row += weight(p);
    }
    return runs;
  }

  void add_entries(Index f, const std::vector<int>& row_of) {
    to.fronts_[f].entries[0] = static_cast<int>(to.entries_.size());
    for (const int node : tree.supernodes[f].nodes) {
      const Index n = static_cast<Index>(node);
      const int column = position[n];
      add_entry(column, column, row_of);
      for (int e = nodes.graph.start[n]; e < nodes.graph.start[n + 1]; ++e) {
        const int row = position[static_cast<Index>(nodes.graph.neighbours[static_cast<Index>(e)])];
        if (row > column) add_entry(row, column, row_of);
      }
    }
    to.fronts_[f].entries[1] = static_cast<int>(to.entries_.size());
  }

  void add_entry(int row, int column, const std::vector<int>& row_of) {
    const int i = nodes.node[static_cast<Index>(node_at[static_cast<Index>(row)])];
    const int j = nodes.node[static_cast<Index>(node_at[static_cast<Index>(column)])];
    Entry entry;
    entry.slot = pattern.slot(std::min(i, j), std::max(i, j));
    entry.row = row_of[static_cast<Index>(row)];
    entry.column = row_of[static_cast<Index>(column)];
    entry.row_mask = to.mask_[static_cast<Index>(i)];
    entry.column_mask = to.mask_[static_cast<Index>(j)];
    entry.transposed = j < i;
    to.entries_.push_back(entry);
  }

  /// Updates of one depth's parity lie on one stack: a front's update never lands on those that it takes.
  void place() {
    std::vector<int> depth(to.fronts_.size(), 0);
    for (Index f = to.fronts_.size(); f-- > 0;) {
      if (to.fronts_[f].parent >= 0) depth[f] = depth[static_cast<Index>(to.fronts_[f].parent)] + 1;
    }
    std::array<std::ptrdiff_t, 2> top{};
    std::ptrdiff_t factor = 0;
    for (Index f = 0; f < to.fronts_.size(); ++f) {
      Front& front = to.fronts_[f];
      front.stack = depth[f] % 2;
      front.factor_start = factor;
      const std::ptrdiff_t panel = static_cast<std::ptrdiff_t>(front.stride) * front.n_pivots;
      factor += panel;
      if (front.children[0] < front.children[1]) {
        const Index first_child = static_cast<Index>(to.children_[static_cast<Index>(front.children[0])]);
        top[1 - static_cast<Index>(front.stack)] = to.fronts_[first_child].update_start;
      }
      front.update_stride = front.stride - front.n_pivots / kernels::row_multiple * kernels::row_multiple;
      front.update_start = top[static_cast<Index>(front.stack)];
      std::ptrdiff_t& end = top[static_cast<Index>(front.stack)];
      end += static_cast<std::ptrdiff_t>(front.update_stride) * (front.n_rows - front.n_pivots);
      to.stack_sizes_[static_cast<Index>(front.stack)] =
          std::max(to.stack_sizes_[static_cast<Index>(front.stack)], end);
      to.largest_stride_ = std::max(to.largest_stride_, front.stride);
      to.largest_panel_ = std::max(to.largest_panel_, panel);
    }
    to.size_.factor_entries = factor;
  }
};

LdltAnalysis::LdltAnalysis(const SymmetricBlockPattern& pattern, NodeMask mask, Ordering ordering)
    : mask_(std::move(mask)),
      block_size_(pattern.block_size()),
      n_blocks_(pattern.n_blocks()),
      n_rows_(pattern.n_rows()) {
  if (mask_.empty()) mask_.assign(static_cast<Index>(pattern.n_nodes()), 0);
  MULDI_EXPECT(mask_.size() == static_cast<Index>(pattern.n_nodes()), "one byte a node");
  const FreeNodes nodes = free_nodes(pattern, mask_);
  const Choice choice = choose(nodes.graph, ordering);
  Builder builder{*this, pattern, nodes, choice.tree, {}, {}, {}, {}, {}};
  builder.number();
  builder.add_fronts();
  builder.find_rows();
  builder.add_maps_and_entries();
  builder.place();
  for (int i = 0; i < pattern.n_nodes(); ++i) {
    for (int c = 0; c < block_size_; ++c) {
      if (((mask_[static_cast<Index>(i)] >> c) & 1) != 0) constrained_.push_back(i * block_size_ + c);
    }
  }
  size_.n_unknowns = static_cast<std::ptrdiff_t>(unknowns_.size());
  size_.factor_bytes = size_.factor_entries * static_cast<std::ptrdiff_t>(sizeof(double));
  size_.n_fronts = static_cast<int>(fronts_.size());
  size_.ordering = choice.ordering;
  for (const Front& front : fronts_) {
    size_.largest_front = std::max(size_.largest_front, front.n_rows);
    for (double rows = front.n_rows; rows > front.n_rows - front.n_pivots; rows -= 1.0) size_.flops += rows * rows;
  }
  const std::ptrdiff_t work = stack_sizes_[0] + stack_sizes_[1] + kernels::pack_size;
  size_.work_bytes = work * static_cast<std::ptrdiff_t>(sizeof(double));
}

}  // namespace muldi::math
