#pragma once
/// Nodes of a solid that are fixed to others of it: x_s = sum_k N_k x_k, and so their potentials. They are eliminated:
/// with T this map from the nodes that stay, rows are T^T r and matrices T^T K T.
///
/// Vectors hold `block` unknowns a node: 1 is the potential, 3 the position, 4 both.
#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "fem/solid/solid_description.hpp"
#include "math/sparse_block_matrix.hpp"

namespace muldi::fem {

class Bonds {
 public:
  /// `data` must outlive the object.
  explicit Bonds(const SolidDescription& data);

  bool empty() const { return data_->bonds.empty(); }
  /// Writes T times the others into the bonded nodes.
  void follow(int block, Eigen::Ref<Eigen::VectorXd> x) const;
  /// Adds T^T times the rows of the bonded nodes, which keep their values, to those of the others.
  void gather(int block, Eigen::Ref<Eigen::VectorXd> rows) const;
  /// The same, and zeroes the rows of the bonded nodes.
  void collect(int block, Eigen::Ref<Eigen::VectorXd> rows) const;
  /// From rows that are gathered to those that the members of the solid account for: what a node is given by its own
  /// member's conditions is held there, and what only one side of a joint is given is held by that side for both.
  void account(int block, Eigen::Ref<Eigen::VectorXd> rows) const;
  /// From rows of constraint forces on positions, gathered, to the forces that the bonds alone exert on the nodes.
  void forces_of_bonds(Eigen::Ref<Eigen::VectorXd> rows) const;
  /// Nodes that are coupled beyond those of one cell.
  std::vector<std::pair<int, int>> pairs(const std::vector<std::array<int, 8>>& cells) const;
  /// Index of the node's bond, or -1.
  int bond_of(int node) const { return of_node_[static_cast<std::size_t>(node)]; }
  /// The nodes that unknown `unknown` (3: the potential) of a node stands for, with weights: itself if it is no
  /// other's.
  struct Terms {
    std::vector<int> nodes;
    std::vector<double> of_position;
    std::vector<double> of_potential;
  };
  Terms terms(int node) const;

 private:
  static bool ties(const Bond& bond, int block, int i) { return bond.potential || (block > 1 && i < 3); }
  /// Of the unknown that is entry i of a block, the bit in SolidDescription::given.
  static int bit(int block, int i) { return block == 1 ? 3 : i; }
  bool is_given(int node, int unknown) const {
    return !data_->given.empty() && (data_->given[static_cast<std::size_t>(node)] >> unknown & 1) != 0;
  }

  const SolidDescription* data_;
  std::vector<int> of_node_;
  std::vector<std::vector<int>> alike_;  // by node that stays: bonds of weight one to it
};

/// T^T K T in place, over one pattern that holds the pairs of the bonds.
class BondFold {
 public:
  BondFold(const Bonds& bonds, const math::SymmetricBlockPattern& pattern);

  /// Rows and columns of the bonded unknowns are left zero.
  void apply(math::SymmetricBlockMatrix& K) const;

 private:
  /// A share of the stored block `from` that goes to the stored block `to`.
  struct Share {
    int to = 0;
    bool transposed = false;
    std::array<double, 2> row = {};  // weights of the rows of positions and of the potential
    std::array<double, 2> column = {};
  };
  struct Source {
    int from = 0;
    std::vector<Share> shares = {};
  };
  static void add(const Share& share, int block, const double* from, double* to);

  std::vector<Source> sources_;
};

}  // namespace muldi::fem
