#pragma once
/// A solid as plain data: mesh, materials, what is prescribed, loads. Made from the scene; read by Solid.
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fem/material.hpp"

namespace muldi::fem {

/// How the volume is kept (numerics 1.4, models I to IV; C4: III and IV have the same unknowns here).
enum class Formulation {
  displacement,          ///< I: U(det F) at every Gauss point
  mean_dilatation,       ///< II: U of the element's mean dilatation
  incompressible,        ///< III: the element's volume is kept at every node in time
  incompressible_direct  ///< IV: the same equations
};

/// factor control + constant, the first with a control only.
struct Value {
  int control = -1;  ///< -1: none
  double constant = 0.0;
  double factor = 1.0;

  double at(std::span<const double> u) const {
    return control < 0 ? constant : factor * u[static_cast<std::size_t>(control)] + constant;
  }
  /// Its derivative when the controls move along `du`.
  double rate(std::span<const double> du) const {
    return control < 0 ? 0.0 : factor * du[static_cast<std::size_t>(control)];
  }
  bool is_zero() const { return (control < 0 || factor == 0.0) && constant == 0.0; }
};

/// One component of the displacement of a node.
struct PrescribedDisplacement {
  int node = 0;
  int component = 0;
  Value value = {};
};

struct PrescribedPotential {
  int node = 0;
  Value value = {};
};

/// An equipotential with a given total charge and unknown potential.
struct FloatingElectrode {
  std::string name = {};
  std::vector<int> nodes = {};  ///< none of them bonded
  Value charge = {};
  int member = 0;
};

/// Nodes whose charge is reported under a name: an electrode with a prescribed potential.
struct Electrode {
  std::string name = {};
  std::vector<int> nodes = {};
  int member = 0;
};

/// Forces on nodes that grow with one number: tractions, body forces.
struct DeadLoad {
  std::vector<int> nodes = {};
  std::vector<Eigen::Vector3d> unit = {};  ///< force on each node for the value 1
  Value value = {};
};

/// A pressure on faces of the deformed solid, against their outward normals.
struct Pressure {
  std::vector<std::array<int, 4>> faces = {};  ///< counterclockwise seen from outside
  Value value = {};
};

/// Free charge on the surface: charge on nodes for the value 1.
struct SurfaceCharge {
  std::vector<int> nodes = {};
  std::vector<double> unit = {};
  Value value = {};
  int member = 0;
};

/// A rigid body that nodes are tied to.
struct Host {
  std::string name = {};
  int pattern_node = 0;    ///< of the model's pattern, with twelve unknowns
  Eigen::Index first = 0;  ///< where phi, d1, d2, d3 begin in q
};

/// A node that is fixed to a body: x = phi + xi_1 d1 + xi_2 d2 + xi_3 d3 (numerics 5.26).
struct Tie {
  int node = 0;
  int host = 0;
  Eigen::Vector3d xi = Eigen::Vector3d::Zero();  ///< body coordinates of the node
};

/// A node that is fixed to others of the same description: x = sum of weights x_to.
struct Bond {
  int node = 0;
  std::vector<int> to = {};          ///< none of them bonded
  std::vector<double> weights = {};  ///< their sum is 1
  bool potential = true;             ///< of the potential too
};

/// One of the solids in a description: a range of its nodes, of its cells, of its materials.
struct Member {
  std::string name = {};
  int first_node = 0;
  int n_nodes = 0;
  int first_cell = 0;
  int n_cells = 0;
  int first_material = 0;
  int n_materials = 0;
};

struct SolidDescription {
  std::string name = {};
  std::string part = {};   ///< energy part and folder, e.g. "muscles/upper"; empty: "solids/<name>"
  Eigen::VectorXd X = {};  ///< reference positions in the scene pose (3 n_nodes)
  std::vector<std::array<int, 8>> cells = {};
  std::vector<int> material_of_cell = {};
  std::vector<Material> materials = {};   ///< with a volumetric law in every formulation but the incompressible ones
  std::vector<double> shear_moduli = {};  ///< of the materials at small strain
  Formulation formulation = Formulation::mean_dilatation;

  std::vector<PrescribedDisplacement> displacements = {};
  std::vector<Host> hosts = {};  ///< ground is none: nodes that it holds have prescribed displacements
  std::vector<Tie> ties = {};    ///< one a node, of nodes without prescribed displacements
  std::vector<Bond> bonds = {};  ///< one a node, of nodes without prescribed displacements and ties
  /// Solids that are fixed to one another, in the order of their nodes; empty: one alone.
  std::vector<Member> members = {};
  /// By node, where there are bonds: bits of what its own member's conditions give, 0 to 2 by displacements and ties to
  /// bodies or to ground, 3 by a named electrode.
  std::vector<std::uint8_t> given = {};
  bool tied_to_ground = false;  ///< prescribed displacements are ties to ground, which does not turn
  std::vector<PrescribedPotential> potentials = {};  ///< none: the solid has no field
  std::vector<FloatingElectrode> floating = {};
  std::vector<Electrode> electrodes = {};
  std::vector<DeadLoad> dead_loads = {};
  std::vector<Pressure> pressures = {};
  std::vector<SurfaceCharge> surface_charges = {};
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();
  std::vector<long> labels_of_nodes = {};  ///< numbers that messages use; empty: those of the mesh
  std::vector<long> labels_of_cells = {};
};

}  // namespace muldi::fem
