#include "fem/solid/solid.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/mutation.hpp"
#include "base/text.hpp"
#include "fem/solid/solid_solver.hpp"

namespace muldi::fem {
namespace {

/// What the kernels see: in every formulation but that of displacements alone the volumetric law works on the element's
/// mean dilatation.
std::vector<Material> element_materials(const SolidDescription& data) {
  std::vector<Material> materials = data.materials;
  if (data.formulation == Formulation::displacement) return materials;
  for (Material& material : materials) material.volumetric.reset();
  return materials;
}

/// With itself as the only member where it has no others.
SolidDescription with_members(SolidDescription data) {
  if (data.members.empty()) {
    data.members = {{.name = data.name,
                     .n_nodes = static_cast<int>(data.X.size() / 3),
                     .n_cells = static_cast<int>(data.cells.size()),
                     .n_materials = static_cast<int>(data.materials.size())}};
  }
  return data;
}

double diagonal(const Eigen::VectorXd& X) {
  const Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic>> nodes(X.data(), 3, X.size() / 3);
  return (nodes.rowwise().maxCoeff() - nodes.rowwise().minCoeff()).norm();
}

}  // namespace

Solid::Solid(SolidDescription data)
    : data_(with_members(std::move(data))),
      elements_(data_.X, data_.cells, data_.material_of_cell, element_materials(data_)),
      unknowns_(data_),
      ties_(data_),
      bonds_(data_),
      loads_(data_, elements_),
      V_(elements_.cell_volumes()),
      size_(diagonal(data_.X)),
      shear_modulus_(*std::max_element(data_.shear_moduli.begin(), data_.shear_moduli.end())),
      mass_(loads_.nodal_mass().sum()),
      force_(Eigen::VectorXd::Zero(data_.X.size())),
      momentum_(force_),
      charge_(Eigen::VectorXd::Zero(elements_.n_nodes())),
      weight_(V_),
      phi_(charge_) {
  if (is_incompressible()) filter_ = PressureFilter(elements_, unknowns_, bonds_);
  q_.size = data_.X.size();
  y_.size = n_potentials() + n_pressures();
  if (unknowns_.n_free_potentials() > 0) {
    potential_solver_ = std::make_unique<PotentialSolver>(elements_, unknowns_, data_, bonds_);
  }
}

Solid::Dilation Solid::dilation(int cell, double J) const {
  const Material& material =
      data_.materials[static_cast<std::size_t>(data_.material_of_cell[static_cast<std::size_t>(cell)])];
  return std::visit(
      [J](const auto& law) {
        return Dilation{law.U(J), law.dU_dJ(J), law.d2U_dJdJ(J)};
      },
      *material.volumetric);
}

ElementFields Solid::fields(const model::IntervalPoint& at) const {
  ElementFields fields{.x = at.q.data() + q_.first};
  if (at.dt > 0.0 || !at.v.segment(q_.first, q_.size).isZero(0.0)) fields.v = at.v.data() + q_.first;
  if (unknowns_.has_field() && at.y != nullptr) fields.phi = at.y->data() + y_.first;
  return fields;
}

const Volumes& Solid::volumes_at(const Eigen::Ref<const Eigen::VectorXd>& x) const {
  for (const int i : {last_volumes_, 1 - last_volumes_}) {
    if (!volumes_[i].belong_to(x)) continue;
    last_volumes_ = i;
    return volumes_[i];
  }
  last_volumes_ = 1 - last_volumes_;
  volumes_[last_volumes_].update(elements_, x);
  return volumes_[last_volumes_];
}

const Eigen::VectorXd& Solid::potentials_at(const Eigen::Ref<const Eigen::VectorXd>& x,
                                            std::span<const double> u) const {
  unknowns_.place_potentials(u, phi_);
  bonds_.follow(1, phi_);
  if (potential_solver_) {
    loads_.surface_charge(u, charge_);
    potential_solver_->solve(x, charge_, phi_);
  }
  return phi_;
}

Eigen::VectorXd Solid::charge_rows(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::VectorXd& phi) const {
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(elements_.n_nodes());
  elements_.forces({.x = x.data(), .phi = phi.data()}, {.charge = rows.data()});
  bonds_.gather(1, rows);
  bonds_.account(1, rows);
  return rows;
}

void Solid::start(Eigen::VectorXd& q, Eigen::VectorXd& y) const {
  positions(q) = data_.X;
  ties_.follow(q_.first, q);
  bonds_.follow(3, positions(q));
  y.segment(y_.first, y_.size).setZero();
}

void Solid::place(const model::Placement& at, Eigen::VectorXd& q, Eigen::VectorXd& y) const {
  unknowns_.place_positions(at.u_end, positions(q));
  ties_.follow(q_.first, q);
  bonds_.follow(3, positions(q));
  if (!unknowns_.has_field()) return;
  unknowns_.place_potentials(at.u, potentials(y));
  bonds_.follow(1, potentials(y));
}

void Solid::settle_stage(const model::IntervalPoint& at, Eigen::VectorXd& y) const {
  if (!potential_solver_) return;
  loads_.surface_charge(at.u, charge_);
  potential_solver_->solve(positions(at.q), charge_, potentials(y));
}

model::PartLimits Solid::add_part_forces(const model::IntervalPoint& at, model::IntervalForces& out) const {
  model::PartLimits limits;
  const bool whole = at.y != nullptr;
  force_.setZero();
  momentum_.setZero();
  ForceTargets targets{.momentum = momentum_.data()};
  if (whole) targets.force = force_.data();
  const ElementFields where = fields(at);
  if (where.phi != nullptr) {
    loads_.surface_charge(at.u, charge_);
    targets.charge = charge_.data();
  }
  limits.margin = elements_.forces(where, targets);
  if (where.v != nullptr) positions(out.momentum) += momentum_;
  if (!whole) return limits;
  if (where.phi != nullptr) {
    potential_scale_ = std::max(potential_scale_, potentials(*at.y).lpNorm<Eigen::Infinity>());
    potentials(out.stage) = -charge_;
    bonds_.gather(1, potentials(out.stage));
    unknowns_.keep_solved_potentials(potentials(out.stage));
  }
  positions(out.force) -= force_;
  if (loads_.any()) loads_.add(positions(at.q), at.u, positions(out.force));
  if (!has_pressures()) return limits;
  if (at.dt > 0.0) {
    add_volume_step(at, out, limits);
  } else {
    add_volume_rest(at, out, limits);
  }
  return limits;
}

double Solid::pressure_weight(const model::IntervalPoint& at) const {
  return is_incompressible() && !at.first ? at.dt : 0.5 * at.dt;
}

void Solid::add_volume_step(const model::IntervalPoint& at, model::IntervalForces& out,
                            model::PartLimits& limits) const {
  const auto p = pressures(*at.y);
  const bool in_middle = base::has(base::Mutation::dilatation_in_middle) && !is_incompressible();
  const Volumes& begin = volumes_at(positions(in_middle ? at.q : at.q0));
  const Volumes& end = volumes_at(positions(in_middle ? at.q : at.q1));
  const double c = pressure_weight(at);
  weight_ = -c * V_.cwiseProduct(p);
  begin.add_gradients(elements_, weight_, positions(out.begin));
  auto rows = pressures(out.stage);
  if (is_incompressible()) {
    rows = V_.cwiseProduct((end.J.array() - 1.0).matrix());
    filter_.keep_rows(rows);
    limits.margin = std::min(limits.margin, end.J.minCoeff());
    limits.violation = std::max(limits.violation, rows.cwiseQuotient(V_).lpNorm<Eigen::Infinity>());
    rows *= -c;
    return;
  }
  end.add_gradients(elements_, weight_, positions(out.end));
  for (int cell = 0; cell < elements_.n_cells(); ++cell) {
    const double J = 0.5 * (begin.J[cell] + end.J[cell]);
    limits.margin = std::min(limits.margin, J);
    const Dilation law = dilation(cell, J);
    rows[cell] = -at.dt * V_[cell] * (law.pressure - p[cell]) / law.stiffness;
  }
}

void Solid::add_volume_rest(const model::IntervalPoint& at, model::IntervalForces& out,
                            model::PartLimits& limits) const {
  const auto p = pressures(*at.y);
  const Volumes& here = volumes_at(positions(at.q));
  weight_ = -V_.cwiseProduct(p);
  here.add_gradients(elements_, weight_, positions(out.force));
  auto rows = pressures(out.stage);
  limits.margin = std::min(limits.margin, here.J.minCoeff());
  if (is_incompressible()) {
    rows = -V_.cwiseProduct((here.J.array() - 1.0).matrix());
    filter_.keep_rows(rows);
    return;
  }
  for (int cell = 0; cell < elements_.n_cells(); ++cell) {
    const Dilation law = dilation(cell, here.J[cell]);
    rows[cell] = -V_[cell] * (law.pressure - p[cell]) / law.stiffness;
  }
}

void Solid::add_control_force(const model::IntervalPoint& at, int control, Eigen::VectorXd& out) const {
  loads_.add_control_force(positions(at.q), control, positions(out));
}

model::IncrementSize Solid::size_of(const Eigen::VectorXd& dq, const Eigen::VectorXd& dy) const {
  model::IncrementSize size;
  size.positions = positions(dq).lpNorm<Eigen::Infinity>() / size_;
  if (has_pressures()) size.stage = pressures(dy).lpNorm<Eigen::Infinity>() / shear_modulus_;
  if (unknowns_.n_free_potentials() > 0) {
    const double change = potentials(dy).lpNorm<Eigen::Infinity>();
    if (change > 0.0) size.stage = std::max(size.stage, change / std::max(potential_scale_, change));
  }
  return size;
}

double Solid::deformation(const Eigen::VectorXd& q, const Eigen::VectorXd& dq) const {
  force_ = positions(dq);
  ties_.add_shared(q_.first, q, dq, -1.0, force_);
  return force_.lpNorm<Eigen::Infinity>() / size_;
}

Eigen::Vector3d Solid::centre_of_mass(const Member& member, const Eigen::VectorXd& q) const {
  const auto mass = loads_.nodal_mass().segment(member.first_node, member.n_nodes);
  const Eigen::Index first = q_.first + 3 * static_cast<Eigen::Index>(member.first_node);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index node = 0; node < mass.size(); ++node) sum += mass[node] * q.segment<3>(first + 3 * node);
  return sum / mass.sum();
}

void Solid::add_multiplier_impulse(const Eigen::VectorXd& q, const Eigen::VectorXd& impulse,
                                   Eigen::VectorXd& rows) const {
  if (!is_incompressible()) return;
  weight_ = V_.cwiseProduct(pressures(impulse));
  volumes_at(positions(q)).add_gradients(elements_, weight_, positions(rows));
}

bool Solid::add_velocity_rows(const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& h) const {
  if (!is_incompressible()) return false;
  volumes_at(positions(q)).project(elements_, positions(v), weight_);
  pressures(h) -= V_.cwiseProduct(weight_);
  return true;
}

Eigen::Index Solid::n_memory() const { return potential_solver_ ? 1 + phi_.size() + potential_solver_->n_memory() : 0; }

void Solid::store_memory(Eigen::Ref<Eigen::VectorXd> out) const {
  if (!potential_solver_) return;
  out[0] = potential_scale_;
  out.segment(1, phi_.size()) = phi_;
  potential_solver_->store_memory(out.tail(potential_solver_->n_memory()));
}

void Solid::restore_memory(const Eigen::Ref<const Eigen::VectorXd>& memory) const {
  if (!potential_solver_) return;
  potential_scale_ = memory[0];
  phi_ = memory.segment(1, phi_.size());
  potential_solver_->restore_memory(memory.tail(potential_solver_->n_memory()));
}

void Solid::request(model::PatternRequest& pattern) const {
  std::vector<int> nodes;
  nodes.reserve(data_.hosts.size());
  for (const Host& host : data_.hosts) nodes.push_back(host.pattern_node);
  pattern.add_clique(nodes);
}

void Solid::follow(std::span<const double> du, Eigen::VectorXd& velocity) const {
  unknowns_.keep_free_positions(positions(velocity));
  if (!du.empty()) unknowns_.place_position_rates(du, positions(velocity));
  ties_.follow(q_.first, velocity);
  bonds_.follow(3, positions(velocity));
}

double Solid::work_of_prescribed(const Eigen::VectorXd& force, const Eigen::VectorXd& motion) const {
  return unknowns_.work_of_prescribed(positions(force), positions(motion));
}

void Solid::keep_free(Eigen::VectorXd& rows) const { unknowns_.keep_free_positions(positions(rows)); }

std::unique_ptr<model::SubstructureSolver> Solid::make_solver(model::Linearisation kind,
                                                              const std::string& name) const {
  return std::make_unique<SolidSolver>(*this, kind, name);
}

model::SolverSize Solid::solver_size(model::Linearisation kind, const std::string& name) const {
  return SolidSolver::size_of(*this, kind, name);
}

void Solid::check_solver(const std::string& name) const { SolidSolver::check(*this, name); }

}  // namespace muldi::fem
