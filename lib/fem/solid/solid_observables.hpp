#pragma once
/// What is recorded of a solid at the nodes in time: fields over its mesh, charges, reactions.
///
/// Potentials and charges are those of electric equilibrium at the positions of the node in time; stresses contain the
/// elastic, electric and viscous parts there. Pressures of the incompressible formulations are the multipliers of the
/// node.
#include <string>
#include <vector>

#include "fem/solid/solid.hpp"
#include "model/observable.hpp"
#include "model/supply.hpp"

namespace muldi::fem {

/// A field over the mesh.
enum class FieldQuantity { position, velocity, potential, pressure, stress, field, true_field, jacobian };

/// A vector of a node, or of several by weights.
enum class PointQuantity { position, displacement, velocity, potential };

/// Nodes with the weights of an average; one node of weight 1 is a point.
struct WeightedNodes {
  std::vector<int> nodes = {};
  std::vector<double> weights = {};
};

/// Values of one solid, computed once a view. The observables refer to it. Nodes are those of the solid's description,
/// where its own begin at member().first_node.
class SolidRecords {
 public:
  /// `member`: which of the solid's members. The solid must outlive the object.
  explicit SolidRecords(const Solid& solid, std::size_t member = 0);
  SolidRecords(const SolidRecords&) = delete;
  SolidRecords& operator=(const SolidRecords&) = delete;

  const Solid& solid() const { return solid_; }
  const Member& member() const { return solid_.members()[member_]; }
  /// Numbers in the solid's description of nodes of this member.
  std::vector<int> nodes(std::vector<int> of_member) const;
  /// Whether an electrode of the description is this member's.
  template <class Electrode>
  bool owns(const Electrode& electrode) const {
    return electrode.member == static_cast<int>(member_);
  }

  /// A field as a history of rows (nodes, 3), (nodes) or one row a cell; stresses are xx, yy, zz, xy, yz, zx.
  model::FieldHistory::Field field(FieldQuantity quantity, const std::string& folder) const;
  /// Charge and potential of all electrodes, `electrodes/<solid>.<electrode>/...`.
  std::vector<model::Observable> electrodes() const;
  /// Gives the model what is wanted of the conductors: `electrodes/<solid>.<electrode>/capacitance` and the energies;
  /// of other prescribed potentials and of surface charges only what counts for the sums.
  void add_electric(const model::ElectricRecord& wanted, model::Model& model) const;

  /// Weighted sum over nodes: a vector, or one entry for the potential.
  Eigen::Vector3d value(PointQuantity quantity, const WeightedNodes& where, const model::NodeView& at) const;
  double potential(const WeightedNodes& where, const model::NodeView& at) const;
  /// Whether a component of the node's displacement is prescribed on this member.
  bool is_held(int node, int component) const;
  /// Force on the solid that holds its prescribed displacements at these nodes.
  Eigen::Vector3d reaction(const std::vector<int>& nodes, const model::NodeView& at) const;
  /// Free charge on these nodes, positive next to field lines that leave them.
  double charge(const std::vector<int>& nodes, const model::NodeView& at) const;

  /// Potentials of all nodes of the description (n_nodes).
  const Eigen::VectorXd& potentials(const model::NodeView& at) const;
  /// Pressures of all cells of the description, positive in tension (n_cells): minus a third of the trace of the
  /// mechanical stress in the formulation of displacements, else those of the volumetric law or the constraint.
  const Eigen::VectorXd& tensions(const model::NodeView& at) const;
  /// Means of all cells of the description over the reference volume, one column a cell.
  struct CellMeans {
    Eigen::Matrix<double, 6, Eigen::Dynamic> stress = {};  ///< Cauchy: xx, yy, zz, xy, yz, zx
    Eigen::Matrix3Xd field = {};                           ///< nominal
    Eigen::Matrix3Xd true_field = {};
  };
  const CellMeans& cell_means(const model::NodeView& at) const;

 private:
  /// A value and the view that it belongs to.
  template <class Value>
  struct Kept {
    Value value = {};
    long serial = -1;
    /// True if it must be computed.
    bool is_old(const model::NodeView& at) {
      const bool old = serial != at.serial;
      serial = at.serial;
      return old;
    }
  };

  void write(FieldQuantity quantity, const model::NodeView& at, std::span<double> out) const;
  model::Terminal terminal_of(const std::vector<int>& nodes) const;
  model::Terminal terminal_of(const FloatingElectrode& electrode) const;
  model::Terminal terminal_of(const SurfaceCharge& charge) const;
  model::Observable electrode(const std::string& name, const std::vector<int>& nodes, bool charge) const;

  const Solid& solid_;
  std::size_t member_;
  mutable Kept<Eigen::VectorXd> reactions_;
  mutable Kept<Eigen::VectorXd> potentials_;
  mutable Kept<Eigen::VectorXd> charges_;
  mutable Kept<Eigen::VectorXd> tensions_;
  mutable Kept<CellMeans> means_;
};

}  // namespace muldi::fem
