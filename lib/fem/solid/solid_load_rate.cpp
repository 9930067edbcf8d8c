/// How the equations of a solid at rest change with the controls: for continuation past limit points.
#include "fem/solid/solid.hpp"

namespace muldi::fem {

void Solid::add_load_rate(const model::IntervalPoint& at, std::span<const double> du, Eigen::VectorXd& rows,
                          Eigen::VectorXd& h) const {
  // What is prescribed moves along dx and dphi: the derivative of the rows is that of the element forces along it.
  Eigen::VectorXd dx = Eigen::VectorXd::Zero(q_.size);
  Eigen::VectorXd dphi = Eigen::VectorXd::Zero(elements_.n_nodes());
  unknowns_.place_position_rates(du, dx);
  bonds_.follow(3, dx);
  if (unknowns_.has_field()) unknowns_.place_potential_rates(du, dphi);
  bonds_.follow(1, dphi);
  ElementFields where = fields(at);
  where.v = nullptr;
  if (has_pressures()) where.pressure = at.y->data() + y_.first + n_potentials();
  Eigen::VectorXd force = Eigen::VectorXd::Zero(q_.size);
  Eigen::VectorXd charge = Eigen::VectorXd::Zero(elements_.n_nodes());
  if (where.phi != nullptr) loads_.surface_charge_rate(du, charge);
  elements_.action(where, {.x = dx.data(), .phi = where.phi != nullptr ? dphi.data() : nullptr},
                   {.force = force.data(), .charge = where.phi != nullptr ? charge.data() : nullptr});
  positions(rows) -= force;
  for (std::size_t control = 0; control < du.size(); ++control) {
    if (du[control] == 0.0) continue;
    force.setZero();
    loads_.add_control_force(positions(at.q), static_cast<int>(control), force);
    positions(rows) += du[control] * force;
  }
  if (where.phi != nullptr) {
    bonds_.gather(1, charge);
    unknowns_.keep_solved_potentials(charge);
    potentials(h) -= charge;
  }
  if (!has_pressures()) return;
  Eigen::VectorXd dJ = Eigen::VectorXd::Zero(n_pressures());
  volumes_at(positions(at.q)).project(elements_, dx, dJ);
  pressures(h) -= V_.cwiseProduct(dJ);
}

}  // namespace muldi::fem
