#include "fem/solid/solid_solver.hpp"

#include <algorithm>
#include <cmath>

#include "fem/solid/solid_factor.hpp"

namespace muldi::fem {
namespace {

/// Stiffness of the volume in the factors of the incompressible formulations, over what resists the smoothest motion.
constexpr double augmentation = 3e2;
/// The same at rest, where volumes are kept exactly by every factor: an iteration less a digit of it, and the exact
/// residuals return the digits that the factor loses.
constexpr double augmentation_at_rest = 1e4;
/// The same where patterns of pressures are filtered out, against which it works in vain.
constexpr double filtered_augmentation = 30.0;
constexpr double pi = 3.14159265358979323846;
constexpr double accuracy_at_rest = 1e-6;
constexpr int max_exact_iterations = 60;

std::vector<std::vector<int>> electrodes_in(const Solid& solid, model::Linearisation kind) {
  std::vector<std::vector<int>> nodes;
  if (kind == model::Linearisation::velocity) return nodes;
  for (const FloatingElectrode& electrode : solid.data().floating) nodes.push_back(electrode.nodes);
  return nodes;
}

std::string name_with(const std::string& linear) { return "solid " + linear; }

int block_size_of(const Solid& solid, model::Linearisation kind) {
  return solid.unknowns().n_free_potentials() > 0 && kind != model::Linearisation::velocity ? 4 : 3;
}

/// Negative pivots of the potentials: all of them where the enthalpy is concave in the field, as it is for physical
/// dielectrics, none where it is convex (numerics C1).
int negative_potentials(const Solid& solid) {
  for (const Material& material : solid.data().materials) {
    if (!material.electric) continue;
    if (largest_electric_curvature(material, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}) > 0.0) return 0;
  }
  return solid.unknowns().n_free_potentials();
}

/// eta of the viscous stress eta d, which resists shear over a step as a modulus eta/dt does; 0 without.
double viscosity_of(const Material& material) {
  return material.viscous ? std::visit([](const auto& law) { return law.viscosity; }, *material.viscous) : 0.0;
}

SolverTask task_of(const Solid& solid, model::Linearisation kind) {
  const bool velocity = kind == model::Linearisation::velocity;
  return {.kind = kind,
          .n_unknowns = solid.unknowns().n_free_positions() + (velocity ? 0 : solid.unknowns().n_free_potentials()),
          .n_negative = velocity ? 0 : negative_potentials(solid),
          .tied = !solid.ties().empty()};
}

math::SymmetricBlockPattern pattern_of(const Solid& solid, model::Linearisation kind) {
  const ElementSet& elements = solid.elements();
  return {elements.n_nodes(), block_size_of(solid, kind), elements.cells(), solid.bonds().pairs(elements.cells())};
}

std::unique_ptr<SolidLinear> linear_of(const Solid& solid, model::Linearisation kind, const std::string& name,
                                       const math::SymmetricBlockPattern& pattern) {
  auto linear = make_linear(task_of(solid, kind), name, pattern, solid.unknowns().mask(), electrodes_in(solid, kind));
  linear->respect(solid.bonds());
  return linear;
}

}  // namespace

SolidSolver::SolidSolver(const Solid& solid, model::Linearisation kind, const std::string& name)
    : solid_(solid),
      kind_(kind),
      open_(is_open(task_of(solid, kind), name)),
      pattern_(pattern_of(solid, kind)),
      slots_(solid.elements().slots_in(pattern_)),
      fold_(solid.bonds(), pattern_),
      expected_negative_(task_of(solid, kind).n_negative),
      linear_(linear_of(solid, kind, open_ ? "iterative" : name, pattern_)),
      turning_(solid.data()),
      responses_(solid.data(), linear_->matrix().n_rows(), pattern_.block_size(), solid.n_pressures(),
                 storage_for(task_of(solid, kind))),
      residual_(solid),
      total_(solid),
      action_(solid),
      direction_(solid),
      product_(solid),
      response_(solid) {
  const Eigen::Index n_nodes = solid.elements().n_nodes();
  rhs_ = Eigen::VectorXd::Zero(linear_->matrix().n_rows());
  for (Eigen::VectorXd* v : {&dx_, &force_}) *v = Eigen::VectorXd::Zero(3 * n_nodes);
  for (Eigen::VectorXd* v : {&weight_, &coupling_, &compliance_, &curvature_, &rows_, &dp_, &scaled_p_}) {
    *v = Eigen::VectorXd::Zero(solid.n_pressures());
  }
}

model::SolverSize SolidSolver::size_of(const Solid& solid, model::Linearisation kind, const std::string& name) {
  const math::SymmetricBlockPattern pattern = pattern_of(solid, kind);
  const double block = pattern.block_size();
  model::SolverSize size{.matrix_bytes = 8.0 * block * block * pattern.n_blocks()};
  const SolverTask task = task_of(solid, kind);
  if (const std::optional<Package> package = package_of(name)) {
    size.solver = name_with(SolidPackage::name_of(*package));
    size.factor_bytes = SolidPackage::bytes_of(pattern, *package, task.n_negative);
  } else if (is_direct(task, name)) {
    const math::LdltSize factor = math::LdltAnalysis(pattern, solid.unknowns().mask()).size();
    size.solver = name_with(factor_name(factor.ordering));
    size.factor_bytes = static_cast<double>(factor.factor_bytes + factor.work_bytes);
  } else {
    const SolidIteration::Options options = iteration_for(task, name);
    size.solver = name_with(SolidIteration::name_of(options));
    size.factor_bytes = SolidIteration::bytes_of(pattern, options);
  }
  return size;
}

void SolidSolver::check(const Solid& solid, const std::string& name) {
  const SolverTask task = task_of(solid, model::Linearisation::step);
  if (!is_direct(task, name)) iteration_for(task, name);
}

std::string SolidSolver::name() const { return name_with(linear_->name()); }

int SolidSolver::unstable_directions() const { return linear_->n_negative() - expected_negative_; }

void SolidSolver::weigh_pressures(const model::IntervalPoint& at) {
  using model::Linearisation;
  const Eigen::VectorXd& V = solid_.cell_volumes();
  const bool step = kind_ == Linearisation::step;
  const double scale = step ? at.dt : 1.0;
  const double c = step ? solid_.pressure_weight(at) : 1.0;
  coupling_ = c * V;
  // The longest waves of volume, with half a wave across the solid, are held least: by their inertia where dt is short.
  const double wave = step ? 2.0 * solid_.size() / (pi * at.dt) : 0.0;
  const double inertia = solid_.mass() / V.sum() * wave * wave;
  const double factor = kind_ == Linearisation::rest ? augmentation_at_rest : augmentation;
  for (Eigen::Index cell = 0; cell < V.size(); ++cell) {
    const auto index = static_cast<std::size_t>(solid_.data().material_of_cell[static_cast<std::size_t>(cell)]);
    const double viscous = step ? viscosity_of(solid_.data().materials[index]) / at.dt : 0.0;
    double stiffness = factor * (solid_.data().shear_moduli[index] + viscous + inertia);
    if (solid_.filter().n_patterns() > 0) {
      stiffness = filtered_augmentation * (solid_.shear_modulus() + viscous + inertia);
    }
    if (!solid_.is_incompressible()) stiffness = solid_.dilation(static_cast<int>(cell), lagged_.J[cell]).stiffness;
    compliance_[cell] = scale * V[cell] / stiffness;
    // The penalty of a step would be four times that of mean dilatation, whose c is half as large.
    if (step && solid_.is_incompressible()) compliance_[cell] *= 4.0;
    if (kind_ == Linearisation::velocity) {
      // The penalty on volume rates is as large as the augmented volume is stiff over the time that a shear wave takes
      // across the solid.
      compliance_[cell] *= solid_.shear_modulus() * std::cbrt(V.sum()) / solid_.mass();
    }
  }
  weight_ = coupling_.cwiseAbs2().cwiseQuotient(compliance_);
}

void SolidSolver::assemble(const model::IntervalPoint& at) {
  using model::Linearisation;
  ElementTangentWeights weights;
  potential_rows_ = 1.0;
  switch (kind_) {
    case Linearisation::step:
      weights.mass = 1.0 / at.dt;
      weights.stiffness = 0.25 * at.dt;
      weights.rate = 0.5;
      weights.x_phi = 0.5 * at.dt;
      weights.phi_phi = at.dt;
      potential_rows_ = at.dt;
      break;
    case Linearisation::velocity:
      weights.mass = 1.0;
      weights.stiffness = weights.x_phi = weights.phi_phi = 0.0;
      break;
    case Linearisation::rest:
      break;
  }
  const bool volume_of_velocity = kind_ == Linearisation::velocity && !solid_.is_incompressible();
  if (solid_.has_pressures() && !volume_of_velocity) {
    lagged_ = solid_.volumes_at(solid_.positions(kind_ == Linearisation::step ? at.q1 : at.q));
    weigh_pressures(at);
    weights.rank_one = weight_.data();
    weights.volume_gradients = lagged_.gradient.data();
    if (kind_ == Linearisation::rest) {
      curvature_ = solid_.pressures(*at.y);
      weights.curvature = curvature_.data();
    }
  } else {
    coupling_.setZero();
    compliance_.setOnes();
  }
  linear_->matrix().set_zero();
  solid_.elements().tangent(solid_.fields(at), weights, {}, slots_, linear_->matrix());
  // In steps it is small beside the inertia, and a restart makes the factor without the controls of that time.
  if (kind_ == Linearisation::rest) {
    solid_.loads().add_stiffness(solid_.positions(at.q), at.u, weights.stiffness, linear_->matrix());
  }
  fold_.apply(linear_->matrix());
}

void SolidSolver::decide(const model::IntervalPoint& at) {
  open_ = false;
  Eigen::VectorXd q = at.q1;
  solid_.positions(q) = solid_.data().X;
  const Eigen::VectorXd v = Eigen::VectorXd::Zero(q.size());
  const Eigen::VectorXd y = Eigen::VectorXd::Zero(at.y != nullptr ? at.y->size() : 0);
  assemble({.q0 = q, .q1 = q, .q = q, .v = v, .u = at.u, .dt = at.dt, .y = &y});
  // The diagonal entries of a trilinear cell are 1/27 of its mass, at eight nodes.
  const double mean_mass = 8.0 / 27.0 * solid_.mass() / (at.dt * pattern_.n_nodes());
  const double limit = stiffest_step(task_of(solid_, kind_).n_unknowns);
  if (stiffness_of_step(linear_->matrix(), solid_.unknowns().mask(), mean_mass) <= limit) return;
  linear_ = linear_of(solid_, kind_, "direct", pattern_);
}

bool SolidSolver::factorise(const model::IntervalPoint& at) {
  // The mass matrix is constant; only volumes that must not change make its equations depend on the configuration.
  const bool constant = kind_ == model::Linearisation::velocity && !solid_.is_incompressible();
  if (constant && factorised_) return true;
  if (lagged_.gradient.size() == 0 && solid_.has_pressures()) {
    lagged_.gradient = Eigen::VectorXd::Zero(24 * solid_.n_pressures());
    lagged_.J = Eigen::VectorXd::Ones(solid_.n_pressures());
  }
  if (open_) decide(at);
  assemble(at);
  factorised_ = linear_->factorise();
  turning_.keep(at.q1);
  if (factorised_ && !responses_.empty()) make_responses();
  accuracy_ = 0.0;
  // What a pressure on an open surface adds to the stiffness is not symmetric.
  if (kind_ == model::Linearisation::rest && solid_.loads().has_pressure(at.u)) linearise(at, accuracy_at_rest);
  return factorised_;
}

void SolidSolver::back_substitute() {
  const Eigen::Index block = pattern_.block_size();
  linear_->solve(rhs_);
  for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
    dx_.segment<3>(3 * node) = rhs_.segment<3>(block * node);
  }
  if (solid_.has_pressures()) {
    lagged_.project(solid_.elements(), dx_, dp_);
    dp_ = (coupling_.cwiseProduct(dp_) - rows_).cwiseQuotient(compliance_);
  }
}

/// With the matrix of the factor. For the incompressible formulations a step leaves what the augmentation has let
/// through to the next iteration.
void SolidSolver::solve_lagged(const SolidVector& rows, SolidVector& out) {
  const Eigen::Index block = pattern_.block_size();
  force_ = rows.x;
  if (solid_.has_pressures()) {
    rows_ = rows.p;
    dp_ = coupling_.cwiseProduct(rows_).cwiseQuotient(compliance_);
    lagged_.add_gradients(solid_.elements(), dp_, force_);
  }
  for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
    rhs_.segment<3>(block * node) = force_.segment<3>(3 * node);
    if (block == 4) rhs_[4 * node + potential_bit] = potential_rows_ * rows.phi[node];
  }
  back_substitute();
  out.x = dx_;
  out.p = dp_;
  out.phi.setZero();
  if (block == 4) {
    for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) out.phi[node] = rhs_[4 * node + potential_bit];
  }
  if (solid_.is_incompressible() && (exact() || solid_.filter().n_patterns() > 1)) refine(out);
}

void SolidSolver::pack_rows(const SolidVector& rows) {
  const Eigen::Index block = pattern_.block_size();
  for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
    rhs_.segment<3>(block * node) = rows.x.segment<3>(3 * node);
    if (block == 4) rhs_[4 * node + potential_bit] = potential_rows_ * rows.phi[node];
  }
}

void SolidSolver::reduce(const Eigen::VectorXd& bracket, const Eigen::VectorXd& h) {
  residual_.x = solid_.positions(bracket);
  if (turning_.is_turned()) turning_.back(residual_.x);
  if (solid_.n_potentials() > 0) residual_.phi = solid_.potentials(h);
  if (solid_.has_pressures()) residual_.p = solid_.pressures(h);
  if (!responses_.empty()) {
    pack_rows(residual_);
    responses_.answer(turning_, rhs_, residual_.p);
  }
  solve_lagged(residual_, total_);
  if (accuracy_ == 0.0) return;
  solve_exactly();
  if (kind_ == model::Linearisation::step) accuracy_ = 0.0;
}

void SolidSolver::linearise(const model::IntervalPoint& at, double accuracy) {
  action_.linearise(at);
  accuracy_ = accuracy;
}

/// The unknowns in their natural sizes, so that errors of all count alike.
void SolidSolver::pack(const SolidVector& from, Eigen::VectorXd& to) const {
  to << from.x / solid_.size(), from.phi / volt(), from.p / solid_.shear_modulus();
}

void SolidSolver::unpack(const Eigen::VectorXd& from, SolidVector& to) const {
  to.x = from.head(to.x.size()) * solid_.size();
  to.phi = from.segment(to.x.size(), to.phi.size()) * volt();
  to.p = from.tail(to.p.size()) * solid_.shear_modulus();
}

/// Newton's increment by GMRES on the exact derivative behind the lagged solution: errors are those of the increment.
void SolidSolver::solve_exactly() {
  const auto product = [this](const Eigen::VectorXd& d, Eigen::VectorXd& out) {
    unpack(d, direction_);
    if (turning_.is_turned()) turn_forth(direction_.x);
    action_.apply(direction_, product_);
    if (turning_.is_turned()) turning_.back(product_.x);
    solve_lagged(product_, response_);
    pack(response_, out);
  };
  const auto same = [](const Eigen::VectorXd& r, Eigen::VectorXd& z) { z = r; };
  start_.resize(total_.x.size() + total_.phi.size() + total_.p.size());
  pack(total_, start_);
  increment_ = start_;
  gmres_.solve(product, same, start_, increment_,
               {.relative_tolerance = accuracy_, .max_iterations = max_exact_iterations});
  unpack(increment_, total_);
}

/// What the compliance of the factor has let through is given back until the volume rows hold to round-off. With A the
/// matrix of the factor, B that of the volume rows, D the compliance: (B A^-1 B^T (1 - delta) + delta D) p = B x -
/// rows, by conjugate gradients with D^-1 in front, whose eigenvalues are near one where the augmentation dominates;
/// the tiny part delta bounds pressures with hardly any force. With filtered patterns N, N^T V N = 1, D = d V: the
/// volume rows hold but for V N a, N^T V p = 0, and elimination of a leaves the same equations less d V N N^T V, for p
/// with its patterns, which are then left out.
void SolidSolver::refine(SolidVector& out) {
  const auto complement = [this](const Eigen::VectorXd& p, Eigen::VectorXd& product) {
    respond(p);
    lagged_.project(solid_.elements(), dx_, product);
    product = (1.0 - proximal) * coupling_.cwiseProduct(product) + proximal * compliance_.cwiseProduct(p);
    solid_.filter().add_patterns(-compliance_[0] / solid_.cell_volumes()[0], p, product);
  };
  const auto inverse_compliance = [this](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    z = r.cwiseQuotient(compliance_);
  };
  // With the pressures of the factor left out, the rows miss D p by what the factor's own solution says.
  rows_ = compliance_.cwiseProduct(out.p);
  out.p.setZero();
  const math::KrylovLimits limits{.relative_tolerance = std::max(refined_, 10.0 * linear_->accuracy()),
                                  .max_iterations = max_refinements};
  // Beyond a loss of stability the complement has other signs, and so it has for filtered patterns.
  if (solid_.filter().n_patterns() > 0 ||
      complement_cg_.solve(complement, inverse_compliance, rows_, out.p, limits).end == math::KrylovEnd::breakdown) {
    complement_minres_.solve(complement, inverse_compliance, rows_, out.p, limits);
  }
  dp_ = (1.0 - proximal) * out.p;
  respond(dp_);
  solid_.filter().keep_pressures(out.p);
  out.x -= dx_;
  if (pattern_.block_size() == 4) {
    for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) out.phi[node] -= rhs_[4 * node + potential_bit];
  }
}

/// A^-1 B^T p, of which dx_ is the part of the positions.
void SolidSolver::respond(const Eigen::VectorXd& p) {
  const Eigen::Index block = pattern_.block_size();
  force_.setZero();
  scaled_p_ = coupling_.cwiseProduct(p);
  lagged_.add_gradients(solid_.elements(), scaled_p_, force_);
  rhs_.setZero();
  for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
    rhs_.segment<3>(block * node) = force_.segment<3>(3 * node);
  }
  linear_->solve(rhs_);
  for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
    dx_.segment<3>(3 * node) = rhs_.segment<3>(block * node);
  }
}

/// Neighbours turn by different angles: bonds hold in the world.
void SolidSolver::turn_forth(Eigen::VectorXd& x) const {
  turning_.forth(x);
  solid_.bonds().follow(3, x);
}

void SolidSolver::expand(Eigen::VectorXd& dq, Eigen::VectorXd& dy) {
  if (!responses_.empty()) add_motion_of_bodies(dq);
  if (turning_.is_turned()) turn_forth(total_.x);
  solid_.positions(dq) = total_.x;
  if (dy.size() == 0) return;
  if (solid_.n_potentials() > 0) solid_.potentials(dy) = total_.phi;
  if (solid_.has_pressures()) solid_.pressures(dy) = total_.p;
}

}  // namespace muldi::fem
