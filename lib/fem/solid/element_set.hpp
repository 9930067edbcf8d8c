#pragma once
/// All elements of a solid: the kernels called chunk by chunk, on several threads where there are some.
#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem/kernel/element_kernels.hpp"
#include "math/sparse_block_matrix.hpp"

namespace muldi::fem {

/// Nodal arrays have three (positions) or one (potentials) entries a node. Results have the same bits for any number of
/// threads. Calls request no memory; `forces` and `energies` use buffers of the set, so one of them at a time.
class ElementSet {
 public:
  /// `X`: reference positions (3 n_nodes); `cells`: eight nodes each; `material_of_cell`: index in `materials`.
  ElementSet(Eigen::VectorXd X, std::vector<std::array<int, 8>> cells, std::vector<int> material_of_cell,
             std::vector<Material> materials, Isa isa = best_isa());
  ElementSet(const ElementSet&) = delete;
  ElementSet& operator=(const ElementSet&) = delete;

  int n_nodes() const { return static_cast<int>(X_.size() / 3); }
  int n_cells() const { return static_cast<int>(cells_.size()); }
  const Eigen::VectorXd& reference() const { return X_; }
  /// V_e (n_cells).
  const Eigen::VectorXd& cell_volumes() const { return V_; }
  const std::vector<std::array<int, 8>>& cells() const { return cells_; }
  const std::vector<Material>& materials() const { return materials_; }
  const Material& material_of(int cell) const {
    return materials_[static_cast<std::size_t>(material_of_cell_[static_cast<std::size_t>(cell)])];
  }
  const std::vector<int>& material_of_cell() const { return material_of_cell_; }
  const ElementKernels& kernels() const { return kernels_; }

  /// Adds the forces of all elements; `fields.X` is filled in. Returns the smallest margin of least_J.
  double forces(ElementFields fields, const ForceTargets& out) const;
  void action(ElementFields fields, const FieldDirections& along, const ForceTargets& out) const;
  /// Adds the weighted tangent to a matrix whose pattern was made from cells().
  void tangent(ElementFields fields, const ElementTangentWeights& weights, const math::NodeMask& fixed,
               std::span<const std::int32_t> slots, math::SymmetricBlockMatrix& K) const;
  void volumes(const double* x, const double* dx, const VolumeTargets& out) const;
  ElementEnergies energies(ElementFields fields) const;
  /// The same, each material for itself.
  void energies(ElementFields fields, std::vector<ElementEnergies>& of_materials) const;
  /// [cell][8] Gauss points.
  void point_values(ElementFields fields, PointValues* out) const;
  /// Adds int N_a b dV, see ElementKernels::loads.
  void loads(const double* b, int width, double* nodal) const;
  /// Slots of the cells' blocks in a pattern, for `tangent`.
  std::vector<std::int32_t> slots_in(const math::SymmetricBlockPattern& pattern) const;

 private:
  void energies_of_chunks(ElementFields fields) const;
  template <class Work>
  void each_chunk(const Work& work) const;

  Eigen::VectorXd X_;
  std::vector<std::array<int, 8>> cells_;
  std::vector<int> material_of_cell_;
  std::vector<Material> materials_;
  std::vector<MaterialLaws> laws_;
  const ElementKernels& kernels_;
  ElementOrder order_;
  Eigen::VectorXd V_;
  mutable std::vector<double> least_of_chunk_;
  mutable std::vector<ElementEnergies> energies_of_chunk_;
};

}  // namespace muldi::fem
