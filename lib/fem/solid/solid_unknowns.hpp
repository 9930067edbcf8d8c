#pragma once
/// Which unknowns of a solid are free, and the values of the others.
#include <Eigen/Core>
#include <span>
#include <vector>

#include "fem/solid/solid_description.hpp"
#include "math/sparse_block_matrix.hpp"

namespace muldi::fem {

/// Bit of the potential in a node's mask; bits 0 to 2 are the components of the position.
inline constexpr int potential_bit = 3;

/// By node: the lowest number of the nodes whose potentials are connected with its own through dielectric cells, bonds
/// and floating electrodes.
std::vector<int> connected_fields(const SolidDescription& data);

class SolidUnknowns {
 public:
  /// `data` must outlive the object.
  explicit SolidUnknowns(const SolidDescription& data);

  /// Unknowns that are not free, those of tied and bonded nodes and potentials of floating electrodes included.
  const math::NodeMask& mask() const { return mask_; }
  bool is_free(int node, int unknown) const { return (mask_[static_cast<std::size_t>(node)] >> unknown & 1) == 0; }
  /// True if there is an electric field at all.
  bool has_field() const { return has_field_; }
  /// Potentials to solve for, floating electrodes included; 0: all are prescribed.
  int n_free_potentials() const { return n_free_potentials_; }
  int n_free_positions() const { return n_free_positions_; }
  /// True if some prescribed position depends on a control.
  bool moves() const { return moves_; }

  /// Writes the prescribed entries of the positions (3 n_nodes).
  void place_positions(std::span<const double> u, Eigen::Ref<Eigen::VectorXd> x) const;
  /// Writes the prescribed entries of the potentials (n_nodes).
  void place_potentials(std::span<const double> u, Eigen::Ref<Eigen::VectorXd> phi) const;
  /// The same for the derivatives when the controls move along `du`.
  void place_position_rates(std::span<const double> du, Eigen::Ref<Eigen::VectorXd> dx) const;
  void place_potential_rates(std::span<const double> du, Eigen::Ref<Eigen::VectorXd> dphi) const;
  /// Work of `force` along `motion` at the prescribed entries of the positions (3 n_nodes).
  double work_of_prescribed(const Eigen::Ref<const Eigen::VectorXd>& force,
                            const Eigen::Ref<const Eigen::VectorXd>& motion) const;
  /// Zeroes the entries of rows of positions that are not free: prescribed, tied or bonded.
  void keep_free_positions(Eigen::Ref<Eigen::VectorXd> rows) const;
  /// Zeroes the rows of prescribed and bonded potentials; those of floating electrodes stay.
  void keep_solved_potentials(Eigen::Ref<Eigen::VectorXd> rows) const;

 private:
  void mask_idle_potentials();
  void keep_fixed_fields(std::vector<char>& busy) const;

  const SolidDescription* data_;
  math::NodeMask mask_;
  std::vector<Eigen::Index> fixed_positions_;   // entries of x
  std::vector<Eigen::Index> fixed_potentials_;  // nodes, without those of floating electrodes
  bool has_field_ = false;
  bool moves_ = false;
  int n_free_potentials_ = 0;
  int n_free_positions_ = 0;
};

}  // namespace muldi::fem
