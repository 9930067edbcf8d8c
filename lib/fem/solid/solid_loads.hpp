#pragma once
/// Loads on a solid: dead forces, gravity, pressures that follow the surface, charges on the surface.
#include <Eigen/Core>
#include <span>

#include "fem/solid/element_set.hpp"
#include "fem/solid/solid_description.hpp"

namespace muldi::fem {

class SolidLoads {
 public:
  /// `data` must outlive the object.
  SolidLoads(const SolidDescription& data, const ElementSet& elements);

  bool any() const { return has_gravity_ || !data_->dead_loads.empty() || !data_->pressures.empty(); }
  /// f += all forces at the configuration x (3 n_nodes).
  void add(const Eigen::Ref<const Eigen::VectorXd>& x, std::span<const double> u, Eigen::Ref<Eigen::VectorXd> f) const;
  /// f += the forces other than gravity: those whose work counts as external.
  void add_external(const Eigen::Ref<const Eigen::VectorXd>& x, std::span<const double> u,
                    Eigen::Ref<Eigen::VectorXd> f) const;
  /// f += d(forces)/du_control.
  void add_control_force(const Eigen::Ref<const Eigen::VectorXd>& x, int control, Eigen::Ref<Eigen::VectorXd> f) const;
  /// True if some pressure follows the surface now.
  bool has_pressure(std::span<const double> u) const;
  /// f += the derivative of the forces at x along dx: pressures turn and grow with their surface.
  void add_change(const Eigen::Ref<const Eigen::VectorXd>& x, std::span<const double> u,
                  const Eigen::Ref<const Eigen::VectorXd>& dx, Eigen::Ref<Eigen::VectorXd> f) const;
  /// K -= weight times the symmetric part of that derivative. It is all of it where the pressed surface is closed or
  /// its edge is held.
  void add_stiffness(const Eigen::Ref<const Eigen::VectorXd>& x, std::span<const double> u, double weight,
                     math::SymmetricBlockMatrix& K) const;
  /// Charges that are put on the nodes (n_nodes); those of floating electrodes on their first node.
  void surface_charge(std::span<const double> u, Eigen::VectorXd& charge) const;
  /// The derivative of surface_charge when the controls move along `du`.
  void surface_charge_rate(std::span<const double> du, Eigen::VectorXd& charge) const;
  /// -m g.x.
  double gravity_energy(const Eigen::Ref<const Eigen::VectorXd>& x, int first, int n_nodes) const;
  /// Mass of each node (n_nodes), and their sum.
  const Eigen::VectorXd& nodal_mass() const { return nodal_mass_; }

 private:
  const SolidDescription* data_;
  Eigen::VectorXd nodal_mass_;
  bool has_gravity_ = false;
};

/// f += value times the force of a unit pressure on a face at the configuration x: -int N_a n da.
void add_face_pressure(const std::array<int, 4>& face, double value, const double* x, double* f);

}  // namespace muldi::fem
