#pragma once
/// Finite-element muscles on rigid bodies, built by hand as a scene would describe them.
#include "support/rigid_system.hpp"
#include "support/solid_system.hpp"

namespace muldi::test {

/// Bodies, joints and controls of `rigid`, and solids tied to them.
struct TiedSystem {
  RigidSystem rigid;
  std::vector<fem::SolidDescription> solids = {};

  /// Ties the nodes of a solid that `where` selects to a body; to ground: holds them. Nodes held before stay so.
  void tie(fem::SolidDescription& solid, const Where& where, int body) const;
};

std::unique_ptr<model::Model> make_model(const TiedSystem& system);

/// The solid number `index` of a model.
const fem::Solid& solid_of(const model::Model& model, std::size_t index);

/// The state at t = 0 with coordinates x and minimal velocities w; `v` (n_q) is added to the velocities of the solids,
/// whose tied nodes follow the bodies.
variational::State tied_state(const model::Model& model, double dt, const Eigen::VectorXd& w,
                              const Eigen::VectorXd& v = {});

/// What a muscle along z is made of.
struct Muscle {
  std::array<int, 3> cells = {2, 2, 4};
  double side = 4.0;  ///< mm
  fem::Formulation formulation = fem::Formulation::incompressible;
  double mu = 0.233;          ///< MPa
  double viscosity = 0.0;     ///< MPa ms
  int field = -1;             ///< control, kV/mm; the potentials of the layers alternate
  double permittivity = 0.0;  ///< pF/mm; 0: no field
};

/// A bar of square section along z from `lower` to `upper` in z, around the axis x = x0, y = 0.
fem::SolidDescription muscle(const std::string& name, const Muscle& how, double x0, std::array<double, 2> z);

/// A body above ground that turns about y through (0, 0, 4), and beside the hinge one muscle from ground to the body:
/// the smallest joint of the kind of the thesis (ch. 5).
TiedSystem hinge_with_muscle(const Muscle& how);

/// `n_joints` bodies in a row along z, hinged about y, with two muscles of 36 mm side by side at every hinge; the field
/// of control 0 acts in those at x > 0, that of control 1 in the others.
TiedSystem chain_with_muscles(int n_joints, Muscle how);

}  // namespace muldi::test
