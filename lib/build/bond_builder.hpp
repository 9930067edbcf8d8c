#pragma once
/// Which nodes of several solids are fixed to which, and what is prescribed on them.
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.hpp"
#include "fem/mesh/mesh.hpp"
#include "fem/solid/solid_description.hpp"
#include "scene/entries.hpp"

namespace muldi::build {

/// Nodes that coincide become one; a node on a face becomes a weighted sum of the face's corners.
class BondBuilder {
 public:
  /// Weights below this are those of a node on an edge for the corners off it.
  static constexpr double no_weight = 1e-9;

  /// `data`: the members side by side, and `meshes` those of the members; all must outlive the object.
  BondBuilder(fem::SolidDescription& data, std::vector<const fem::Mesh*> meshes, std::vector<base::Diagnostic>& errors);

  /// Makes two nodes one; `origin`: of the attachment that says so.
  void unite(int a, int b, const scene::Origin& origin);
  /// Fixes a node to others; `origin`: of the attachment that says so.
  void fix(int node, std::vector<int> to, std::vector<double> weights, const scene::Origin& origin);
  /// Whether all nodes that have a weight are given what the node is given: displacements, ties, potentials.
  bool agree(int node, const std::vector<int>& to, const std::vector<double>& weights);
  /// Makes the bonds, moves the bonded nodes to where they belong, and hands what is prescribed on bonded nodes to
  /// those that they are fixed to. Errors where nodes are fixed to two places or in a ring, or where conditions
  /// contradict one another.
  void finish();

 private:
  /// A weighted sum of nodes that are themselves free.
  using Sum = std::map<int, double>;
  struct Fixed {
    Sum to;
    const scene::Origin* origin = nullptr;
  };

  /// What is prescribed on a node: a value, or (control -2) the body that it is tied to.
  using Given = std::map<int, fem::Value>;
  int root(int node);
  std::string name_of(int node) const;
  bool resolve();
  /// The sum that a root stands for: itself if it is fixed to nothing.
  std::optional<Sum> resolve(int node);
  void make_bonds();
  void close_gaps();
  void give();
  void hand_over_displacements();
  void hand_over_ties();
  void hand_over_potentials();
  void hand_over_floating();
  /// Roots that the bond of a fixed root leads to; null for a free one.
  const Sum* sum_of(int root) const;
  void refuse(int node, const std::string& what);
  fem::Bond& bond_of(int node) { return data_.bonds[static_cast<std::size_t>(bond_of_node_.at(node))]; }
  bool is_busy(int node) const { return busy_[static_cast<std::size_t>(node)] != 0; }
  void find_dielectrics();
  bool ties_potential(int node);

  fem::SolidDescription& data_;
  std::vector<const fem::Mesh*> meshes_;
  std::vector<base::Diagnostic>& errors_;
  std::vector<int> parent_;
  std::vector<int> count_;                       // nodes of a root
  std::vector<std::pair<int, Fixed>> said_;      // by `fix`
  std::map<int, const scene::Origin*> origins_;  // of roots that nodes were united to
  std::map<int, Fixed> fixed_;                   // by root
  std::map<int, std::optional<Sum>> sums_;       // by fixed root, once resolved; none: on the way
  std::map<int, int> bond_of_node_;
  std::optional<std::map<int, Given>> given_;  // by node, once asked for
  std::vector<char> busy_;
};

}  // namespace muldi::build
