#include "fem/solid/potential_solver.hpp"

#include <cmath>

#include "math/vector_loops.hpp"

namespace muldi::fem {
namespace {

/// Potentials up to which a factor is kept.
constexpr int direct_potentials = 30000;
constexpr int max_newton = 20;
constexpr int max_cg = 60;
constexpr int cg_with_fresh_factor = 12;  // beyond, the factor is made anew
constexpr double cg_reduction = 1e-13;
constexpr double cg_reduction_of_large = 1e-5;  // with a kept matrix
constexpr int slow_newton = 8;                  // iterations beyond which it is made anew
constexpr double newton_tolerance = 1e-13;      // of the potentials

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

math::SymmetricBlockPattern PotentialSolver::pattern() const {
  return {elements_.n_nodes(), 4, elements_.cells(), bonds_.pairs(elements_.cells())};
}

PotentialSolver::Factor::Factor(const PotentialSolver& of)
    : pattern(of.pattern()),
      slots(of.elements_.slots_in(pattern)),
      fold(of.bonds_, pattern),
      factor(pattern, potential_mask(of.unknowns_.mask()), nodes_of(of.data_.floating)) {
  factor.respect(of.bonds_);
}

PotentialSolver::PotentialSolver(const ElementSet& elements, const SolidUnknowns& unknowns,
                                 const SolidDescription& data, const Bonds& bonds)
    : elements_(elements), unknowns_(unknowns), data_(data), bonds_(bonds) {
  if (unknowns.n_free_potentials() <= direct_potentials || !data.floating.empty()) {
    factor_ = std::make_unique<Factor>(*this);
  }
  for (Eigen::VectorXd* v : {&r_, &z_, &d_, &Ad_, &step_}) *v = Eigen::VectorXd::Zero(elements.n_nodes());
  if (!is_large()) full_ = Eigen::VectorXd::Zero(4 * elements.n_nodes());
  factor_x_ = Eigen::VectorXd::Zero(3 * elements.n_nodes());
  factor_phi_ = step_;
}

void PotentialSolver::factorise(const Eigen::Ref<const Eigen::VectorXd>& x,
                                const Eigen::Ref<const Eigen::VectorXd>& phi) {
  const ElementFields at{.x = x.data(), .phi = phi.data()};
  if (is_large()) {
    make_multigrid(at);
    factorised_ = true;
  } else {
    math::SymmetricBlockMatrix& matrix = factor_->factor.matrix();
    matrix.set_zero();
    elements_.tangent(at, {.stiffness = 0.0, .x_phi = 0.0}, {}, factor_->slots, matrix);
    factor_->fold.apply(matrix);
    factorised_ = factor_->factor.factorise();
  }
  factor_x_ = x;
  factor_phi_ = phi;
}

void PotentialSolver::make_multigrid(const ElementFields& at) {
  multigrid_.reset();
  const math::NodeMask mask = potential_mask(unknowns_.mask());
  const math::SymmetricBlockPattern pattern = this->pattern();
  math::SymmetricBlockMatrix matrix(pattern);
  elements_.tangent(at, {.stiffness = 0.0, .x_phi = 0.0}, {}, elements_.slots_in(pattern), matrix);
  BondFold(bonds_, pattern).apply(matrix);
  double sign = 1.0;
  for (std::size_t node = 0; node < mask.size(); ++node) {
    const double diagonal = matrix.values()[16 * static_cast<std::size_t>(pattern.row_start()[node]) + 15];
    if ((mask[node] >> potential_bit & 1) == 0) sign = diagonal < 0.0 ? -1.0 : 1.0;
  }
  matrix.constrain(mask, sign);
  math::DoubleCsr laplacian = math::component_matrix(matrix, potential_bit, sign);
  math::AggregationMultigrid cycle(laplacian);
  const Eigen::VectorXf zero = Eigen::VectorXf::Zero(elements_.n_nodes());
  multigrid_.emplace(Multigrid{std::move(laplacian), std::move(cycle), sign, zero, zero});
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
  bonds_.gather(1, rows);
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
  if (is_large()) {
    // Near the sizes of single precision nothing is lost: the scale of r does not matter.
    const double size = r.lpNorm<Eigen::Infinity>();
    if (size > 0.0) multigrid_->r = (r / size).cast<float>();
    multigrid_->cycle.apply(multigrid_->r, multigrid_->z);
    z = multigrid_->sign * size * multigrid_->z.cast<double>();
    return;
  }
  full_.setZero();
  for (Eigen::Index node = 0; node < r.size(); ++node) full_[4 * node + potential_bit] = r[node];
  factor_->factor.solve(full_);
  for (Eigen::Index node = 0; node < r.size(); ++node) z[node] = full_[4 * node + potential_bit];
}

void PotentialSolver::multiply(const ElementFields& at, const Eigen::VectorXd& d, Eigen::VectorXd& out) const {
  if (is_large()) {
    math::for_vector_chunks(d.size(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
      for (std::ptrdiff_t i = first; i < first + n; ++i) {
        out[i] = multigrid_->sign * multigrid_->matrix.row_times(i, d.data());
      }
    });
  } else {
    out.setZero();
    elements_.action(at, {.phi = d.data()}, {.charge = out.data()});
  }
  condense(out);
}

int PotentialSolver::conjugate_gradients(const ElementFields& at) {
  step_.setZero();
  precondition(r_, z_);
  d_ = z_;
  double rz = r_.dot(z_);
  const double reduction = is_large() ? cg_reduction_of_large : cg_reduction;
  const double goal = std::abs(rz) * reduction * reduction;
  int iterations = 0;
  while (std::abs(rz) > goal && iterations < max_cg) {
    ++iterations;
    multiply(at, d_, Ad_);
    const double dAd = d_.dot(Ad_);
    if (dAd == 0.0) break;
    const double length = rz / dAd;
    step_ += length * d_;
    r_ -= length * Ad_;
    precondition(r_, z_);
    const double next = r_.dot(z_);
    // Single precision wants the form of Polak and Ribiere: the new residual less the old one.
    const double turn = is_large() ? -length * Ad_.dot(z_) / rz : next / rz;
    d_ = z_ + turn * d_;
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
    const int needed = conjugate_gradients(at);
    if (is_large() ? iteration == slow_newton : needed > cg_with_fresh_factor) factorised_ = false;
    bonds_.follow(1, step_);
    phi += step_;
    const double change = step_.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(change)) return false;
    if (change <= newton_tolerance * phi.lpNorm<Eigen::Infinity>()) return true;
  }
  return false;
}

}  // namespace muldi::fem
