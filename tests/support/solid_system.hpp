#pragma once
/// Finite-element solids built by hand, as a scene would describe them, in models without bodies.
#include <Eigen/Dense>
#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "fem/solid/solid.hpp"
#include "model/model.hpp"
#include "statics/equilibrium.hpp"
#include "support/fem_patch.hpp"
#include "variational/state.hpp"

namespace muldi::test {

/// Selects nodes by their reference positions.
using Where = std::function<bool(const Eigen::Vector3d&)>;

/// Nodes in the plane X_component = value.
Where plane(int component, double value);

/// A solid with conditions on selected nodes, and controls.
struct SolidSystem {
  fem::SolidDescription solid;
  std::vector<model::Control> controls = {};

  int n_nodes() const { return static_cast<int>(solid.X.size() / 3); }
  Eigen::Vector3d node(int n) const { return solid.X.segment<3>(3 * static_cast<Eigen::Index>(n)); }
  std::vector<int> nodes(const Where& where) const;
  /// The only node at a position.
  int node_at(const Eigen::Vector3d& X) const;
  /// Prescribes one component of the displacement.
  void hold(const Where& where, int component, fem::Value value = {});
  /// Symmetry about the planes through the lower corner of the solid's bounding box.
  void hold_lower_faces();
  void set_potential(const Where& where, fem::Value value);
  /// One material for all cells; `shear_modulus` at small strain.
  void fill(const fem::Material& material, double shear_modulus, fem::Formulation formulation);
  /// Adds a control; the value that follows it.
  fem::Value control(base::TimeFunction function);
};

/// A regular mesh of the box between two corners.
SolidSystem solid_box(std::array<int, 3> cells, const Eigen::Vector3d& lower, const Eigen::Vector3d& upper);
SolidSystem solid_of(const FemPatch& patch);

/// Elastic law by formulation: `displacement` Bonet and Wood with lambda, `mean_dilatation` neo-Hookean and quadratic
/// with the same bulk modulus, the others neo-Hookean.
fem::Material rubber(double mu, double lambda, fem::Formulation formulation);

inline constexpr std::array<fem::Formulation, 4> formulations = {
    fem::Formulation::displacement, fem::Formulation::mean_dilatation, fem::Formulation::incompressible,
    fem::Formulation::incompressible_direct};

std::unique_ptr<model::Model> make_model(const SolidSystem& system);
const fem::Solid& solid_in(const model::Model& model);

/// The reference configuration moving with the nodal velocities v (n_q); at rest if v is empty. `dt`: of the run.
variational::State moving_state(const model::Model& model, double dt, const Eigen::VectorXd& v = {});
/// Where statics start.
statics::StaticState static_start(const model::Model& model);
/// Velocities (n_q) of a rigid rotation about the origin.
Eigen::VectorXd spin(const SolidSystem& system, const Eigen::Vector3d& omega);

}  // namespace muldi::test
