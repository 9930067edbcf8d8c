#include "fem/solid/potential_solver.hpp"

#include <cmath>

namespace muldi::fem {
namespace {

constexpr int max_newton = 20;
constexpr int max_cg = 60;
constexpr int cg_with_fresh_factor = 12;  // beyond, the factor is made anew
constexpr double cg_reduction = 1e-13;
constexpr double newton_tolerance = 1e-13;  // of the potentials

/// Every position is held.
math::NodeMask potential_mask(const math::NodeMask& mask) {
  math::NodeMask held(mask);
  for (std::uint8_t& bits : held) bits |= 0b111;
  return held;
}

std::vector<std::vector<int>> nodes_of(const std::vector<FloatingElectrode>& electrodes) {
  std::vector<std::vector<int>> nodes;
  nodes.reserve(electrodes.size());
  for (const FloatingElectrode& electrode : electrodes) nodes.push_back(electrode.nodes);
  return nodes;
}

}  // namespace

PotentialSolver::PotentialSolver(const ElementSet& elements, const SolidUnknowns& unknowns,
                                 const SolidDescription& data)
    : elements_(elements),
      unknowns_(unknowns),
      data_(data),
      pattern_(elements.n_nodes(), 4, elements.cells()),
      slots_(elements.slots_in(pattern_)),
      factor_(pattern_, potential_mask(unknowns.mask()), nodes_of(data.floating)) {
  for (Eigen::VectorXd* v : {&r_, &z_, &d_, &Ad_, &step_}) *v = Eigen::VectorXd::Zero(elements.n_nodes());
  full_ = Eigen::VectorXd::Zero(4 * elements.n_nodes());
  factor_x_ = Eigen::VectorXd::Zero(3 * elements.n_nodes());
  factor_phi_ = step_;
}

void PotentialSolver::factorise(const Eigen::Ref<const Eigen::VectorXd>& x,
                                const Eigen::Ref<const Eigen::VectorXd>& phi) {
  factor_.matrix().set_zero();
  elements_.tangent({.x = x.data(), .phi = phi.data()}, {.stiffness = 0.0, .x_phi = 0.0}, {}, slots_, factor_.matrix());
  factorised_ = factor_.factorise();
  factor_x_ = x;
  factor_phi_ = phi;
}

void PotentialSolver::store_memory(Eigen::Ref<Eigen::VectorXd> out) const {
  out[0] = factorised_ ? 1.0 : 0.0;
  out.segment(1, factor_x_.size()) = factor_x_;
  out.tail(factor_phi_.size()) = factor_phi_;
}

void PotentialSolver::restore_memory(const Eigen::Ref<const Eigen::VectorXd>& memory) {
  factorised_ = false;
  if (memory[0] != 0.0) factorise(memory.segment(1, factor_x_.size()), memory.tail(factor_phi_.size()));
}

void PotentialSolver::condense(Eigen::VectorXd& rows) const {
  unknowns_.keep_solved_potentials(rows);
  for (const FloatingElectrode& electrode : data_.floating) {
    double sum = 0.0;
    for (const int node : electrode.nodes) {
      sum += rows[node];
      rows[node] = 0.0;
    }
    rows[electrode.nodes.front()] = sum;
  }
}

void PotentialSolver::precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) {
  full_.setZero();
  for (Eigen::Index node = 0; node < r.size(); ++node) full_[4 * node + potential_bit] = r[node];
  factor_.solve(full_);
  for (Eigen::Index node = 0; node < r.size(); ++node) z[node] = full_[4 * node + potential_bit];
}

int PotentialSolver::conjugate_gradients(const ElementFields& at) {
  step_.setZero();
  precondition(r_, z_);
  d_ = z_;
  double rz = r_.dot(z_);
  const double goal = std::abs(rz) * cg_reduction * cg_reduction;
  int iterations = 0;
  while (std::abs(rz) > goal && iterations < max_cg) {
    ++iterations;
    Ad_.setZero();
    elements_.action(at, {.phi = d_.data()}, {.charge = Ad_.data()});
    condense(Ad_);
    const double dAd = d_.dot(Ad_);
    if (dAd == 0.0) break;
    const double length = rz / dAd;
    step_ += length * d_;
    r_ -= length * Ad_;
    precondition(r_, z_);
    const double next = r_.dot(z_);
    d_ = z_ + (next / rz) * d_;
    rz = next;
  }
  return iterations;
}

bool PotentialSolver::solve(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::VectorXd& surface_charge,
                            Eigen::Ref<Eigen::VectorXd> phi) {
  const ElementFields at{.x = x.data(), .phi = phi.data()};
  for (int iteration = 0; iteration < max_newton; ++iteration) {
    r_ = surface_charge;
    elements_.forces(at, {.charge = r_.data()});
    r_ = -r_;
    condense(r_);
    if (!factorised_) factorise(x, phi);
    if (!factorised_) return false;
    if (conjugate_gradients(at) > cg_with_fresh_factor) factorised_ = false;
    phi += step_;
    const double change = step_.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(change)) return false;
    if (change <= newton_tolerance * phi.lpNorm<Eigen::Infinity>()) return true;
  }
  return false;
}

}  // namespace muldi::fem
