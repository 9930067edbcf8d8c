#include "fem/solid/bonds.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace muldi::fem {
namespace {

constexpr double whole = 1.0 - 1e-12;

Eigen::Index entry(int block, int node, int i) { return static_cast<Eigen::Index>(block) * node + i; }

}  // namespace

Bonds::Bonds(const SolidDescription& data)
    : data_(&data),
      of_node_(static_cast<std::size_t>(data.X.size() / 3), -1),
      alike_(data.bonds.empty() ? 0 : of_node_.size()) {
  for (std::size_t k = 0; k < data.bonds.size(); ++k) {
    const Bond& bond = data.bonds[k];
    of_node_[static_cast<std::size_t>(bond.node)] = static_cast<int>(k);
    if (bond.to.size() == 1 && bond.weights[0] > whole) {
      alike_[static_cast<std::size_t>(bond.to[0])].push_back(static_cast<int>(k));
    }
  }
  for (const Bond& bond : data.bonds) {
    for (const int node : bond.to) MULDI_EXPECT(bond_of(node) < 0, "what a node is fixed to is itself free");
  }
}

void Bonds::follow(int block, Eigen::Ref<Eigen::VectorXd> x) const {
  for (const Bond& bond : data_->bonds) {
    for (int i = 0; i < block; ++i) {
      if (!ties(bond, block, i)) continue;
      double sum = 0.0;
      for (std::size_t k = 0; k < bond.to.size(); ++k) sum += bond.weights[k] * x[entry(block, bond.to[k], i)];
      x[entry(block, bond.node, i)] = sum;
    }
  }
}

void Bonds::gather(int block, Eigen::Ref<Eigen::VectorXd> rows) const {
  for (const Bond& bond : data_->bonds) {
    for (int i = 0; i < block; ++i) {
      if (!ties(bond, block, i)) continue;
      const double row = rows[entry(block, bond.node, i)];
      for (std::size_t k = 0; k < bond.to.size(); ++k) rows[entry(block, bond.to[k], i)] += bond.weights[k] * row;
    }
  }
}

void Bonds::collect(int block, Eigen::Ref<Eigen::VectorXd> rows) const {
  gather(block, rows);
  for (const Bond& bond : data_->bonds) {
    for (int i = 0; i < block; ++i) {
      if (ties(bond, block, i)) rows[entry(block, bond.node, i)] = 0.0;
    }
  }
}

void Bonds::account(int block, Eigen::Ref<Eigen::VectorXd> rows) const {
  for (const Bond& bond : data_->bonds) {
    for (int i = 0; i < block; ++i) {
      if (!ties(bond, block, i) || !is_given(bond.node, bit(block, i))) continue;
      const double row = rows[entry(block, bond.node, i)];
      for (std::size_t k = 0; k < bond.to.size(); ++k) rows[entry(block, bond.to[k], i)] -= bond.weights[k] * row;
    }
  }
  for (std::size_t node = 0; node < alike_.size(); ++node) {
    for (int i = 0; i < block && !alike_[node].empty(); ++i) {
      if (is_given(static_cast<int>(node), bit(block, i))) continue;
      const auto side = std::find_if(alike_[node].begin(), alike_[node].end(), [&](int k) {
        const Bond& bond = data_->bonds[static_cast<std::size_t>(k)];
        return ties(bond, block, i) && is_given(bond.node, bit(block, i));
      });
      if (side == alike_[node].end()) continue;
      double& row = rows[entry(block, static_cast<int>(node), i)];
      rows[entry(block, data_->bonds[static_cast<std::size_t>(*side)].node, i)] += row;
      row = 0.0;
    }
  }
}

void Bonds::forces_of_bonds(Eigen::Ref<Eigen::VectorXd> rows) const {
  const Eigen::VectorXd gathered = rows;
  Eigen::VectorXd accounted = rows;
  account(3, accounted);
  rows.setZero();
  for (const Bond& bond : data_->bonds) {
    for (int i = 0; i < 3; ++i) {
      const Eigen::Index at = entry(3, bond.node, i);
      // What the node's own conditions hold beyond its own row they hold for the other side.
      const double force = is_given(bond.node, i) ? gathered[at] - accounted[at] : gathered[at];
      rows[at] += force;
      for (std::size_t k = 0; k < bond.to.size(); ++k) rows[entry(3, bond.to[k], i)] -= bond.weights[k] * force;
    }
  }
}

Bonds::Terms Bonds::terms(int node) const {
  const int index = bond_of(node);
  if (index < 0) return {{node}, {1.0}, {1.0}};
  const Bond& bond = data_->bonds[static_cast<std::size_t>(index)];
  Terms terms{bond.to, bond.weights, bond.potential ? bond.weights : std::vector<double>(bond.to.size(), 0.0)};
  if (!bond.potential) {
    terms.nodes.push_back(node);
    terms.of_position.push_back(0.0);
    terms.of_potential.push_back(1.0);
  }
  return terms;
}

std::vector<std::pair<int, int>> Bonds::pairs(const std::vector<std::array<int, 8>>& cells) const {
  std::vector<std::pair<int, int>> pairs;
  if (empty()) return pairs;
  std::vector<int> reached;
  for (const auto& cell : cells) {
    reached.assign(cell.begin(), cell.end());
    for (const int node : cell) {
      if (bond_of(node) < 0) continue;
      const Bond& bond = data_->bonds[static_cast<std::size_t>(bond_of(node))];
      reached.insert(reached.end(), bond.to.begin(), bond.to.end());
    }
    if (reached.size() == cell.size()) continue;
    for (std::size_t a = 0; a < reached.size(); ++a) {
      for (std::size_t b = std::max<std::size_t>(a + 1, cell.size()); b < reached.size(); ++b) {
        if (reached[a] != reached[b]) pairs.emplace_back(reached[a], reached[b]);
      }
    }
  }
  return pairs;
}

BondFold::BondFold(const Bonds& bonds, const math::SymmetricBlockPattern& pattern) {
  if (bonds.empty()) return;
  const auto row_start = pattern.row_start();
  for (int i = 0; i < pattern.n_nodes(); ++i) {
    for (int slot = row_start[static_cast<std::size_t>(i)]; slot < row_start[static_cast<std::size_t>(i) + 1]; ++slot) {
      const int j = pattern.columns()[static_cast<std::size_t>(slot)];
      if (bonds.bond_of(i) < 0 && bonds.bond_of(j) < 0) continue;
      Source source{.from = slot};
      const Bonds::Terms rows = bonds.terms(i);
      const Bonds::Terms columns = bonds.terms(j);
      for (std::size_t a = 0; a < rows.nodes.size(); ++a) {
        for (std::size_t b = 0; b < columns.nodes.size(); ++b) {
          const int row = rows.nodes[a];
          const int column = columns.nodes[b];
          // The mirror image of a diagonal block's share (a, b) is its share (b, a).
          if (i == j && row > column) continue;
          const std::array<double, 2> of_row{rows.of_position[a], rows.of_potential[a]};
          const std::array<double, 2> of_column{columns.of_position[b], columns.of_potential[b]};
          const int to = pattern.slot(std::min(row, column), std::max(row, column));
          if (to < 0) continue;  // blocks that no cell fills
          if (row <= column) source.shares.push_back({to, false, of_row, of_column});
          if (row > column || (row == column && i != j)) source.shares.push_back({to, true, of_row, of_column});
        }
      }
      sources_.push_back(std::move(source));
    }
  }
}

void BondFold::add(const Share& share, int block, const double* from, double* to) {
  for (int r = 0; r < block; ++r) {
    for (int c = 0; c < block; ++c) {
      const double value = share.row[r < 3 ? 0 : 1] * share.column[c < 3 ? 0 : 1] * from[block * r + c];
      to[share.transposed ? block * c + r : block * r + c] += value;
    }
  }
}

void BondFold::apply(math::SymmetricBlockMatrix& K) const {
  const int block = K.block_size();
  std::array<double, 16> from{};
  for (const Source& source : sources_) {
    double* values = K.values().data() + static_cast<std::ptrdiff_t>(source.from) * block * block;
    std::copy(values, values + static_cast<std::ptrdiff_t>(block) * block, from.begin());
    std::fill(values, values + static_cast<std::ptrdiff_t>(block) * block, 0.0);
    for (const Share& share : source.shares) {
      add(share, block, from.data(), K.values().data() + static_cast<std::ptrdiff_t>(share.to) * block * block);
    }
  }
}

}  // namespace muldi::fem
