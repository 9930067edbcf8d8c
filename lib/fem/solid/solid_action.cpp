#include "fem/solid/solid_action.hpp"

namespace muldi::fem {

SolidAction::SolidAction(const Solid& solid) : solid_(solid), compliance_(Eigen::VectorXd::Zero(solid.n_pressures())) {
  for (Eigen::VectorXd* v : {&dx_, &dv_, &force_, &momentum_})
    *v = Eigen::VectorXd::Zero(3 * solid.elements().n_nodes());
  weight_ = compliance_;
}

void SolidAction::linearise(const model::IntervalPoint& at) {
  dt_ = at.dt;
  u_.assign(at.u.begin(), at.u.end());
  x_ = solid_.positions(at.q);
  moves_ = solid_.fields(at).v != nullptr;
  v_ = solid_.positions(at.v);
  if (solid_.n_potentials() > 0) phi_ = solid_.potentials(*at.y);
  if (!solid_.has_pressures()) return;
  p_ = solid_.pressures(*at.y);
  const bool step = dt_ > 0.0;
  end_ = solid_.volumes_at(solid_.positions(step ? at.q1 : at.q));
  if (step) begin_ = solid_.volumes_at(solid_.positions(at.q0));
  coupling_ = step ? solid_.pressure_weight(at) : 1.0;
  if (solid_.is_incompressible()) return;
  for (int cell = 0; cell < solid_.elements().n_cells(); ++cell) {
    const double J = step ? 0.5 * (begin_.J[cell] + end_.J[cell]) : end_.J[cell];
    // The change of the stiffness itself is left out: it belongs to a factor that is zero at the solution.
    compliance_[cell] = (step ? dt_ : 1.0) * solid_.cell_volumes()[cell] / solid_.dilation(cell, J).stiffness;
  }
}

void SolidAction::apply(const SolidVector& d, SolidVector& out) {
  const bool step = dt_ > 0.0;
  const ElementSet& elements = solid_.elements();
  dx_ = (step ? 0.5 : 1.0) * d.x;
  ElementFields at{.x = x_.data()};
  FieldDirections along{.x = dx_.data()};
  ForceTargets to{.force = force_.data()};
  force_.setZero();
  momentum_.setZero();
  out.phi.setZero();
  if (step) {
    dv_ = d.x / dt_;
    along.v = dv_.data();
    to.momentum = momentum_.data();
  }
  if (moves_) at.v = v_.data();
  if (solid_.n_potentials() > 0) {
    at.phi = phi_.data();
    along.phi = d.phi.data();
    to.charge = out.phi.data();
  }
  if (solid_.has_pressures() && !step) {
    at.pressure = p_.data();
    along.pressure = d.p.data();
  }
  elements.action(at, along, to);
  force_ = -force_;
  solid_.loads().add_change(x_, u_, dx_, force_);
  if (!step) {
    out.x = -force_;
  } else {
    out.x = momentum_ - 0.5 * dt_ * force_;
  }
  if (solid_.n_potentials() > 0) solid_.bonds().collect(1, out.phi);
  if (!solid_.has_pressures()) {
    solid_.bonds().collect(3, out.x);
    return;
  }
  const Eigen::VectorXd& V = solid_.cell_volumes();
  if (step) {
    weight_ = coupling_ * V.cwiseProduct(d.p);
    begin_.add_gradients(elements, weight_, out.x);
  }
  end_.project(elements, d.x, out.p);
  solid_.bonds().collect(3, out.x);
  out.p = coupling_ * V.cwiseProduct(out.p);
  solid_.filter().keep_rows(out.p);
  if (!solid_.is_incompressible()) out.p -= compliance_.cwiseProduct(d.p);
}

}  // namespace muldi::fem
