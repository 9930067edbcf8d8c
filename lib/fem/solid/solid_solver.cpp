#include "fem/solid/solid_solver.hpp"

#include <cmath>

namespace muldi::fem {
namespace {

/// Stiffness of the volume in the factors of the incompressible formulations, over what resists the smoothest motion.
constexpr double augmentation = 3e2;
constexpr double pi = 3.14159265358979323846;
constexpr int max_refinements = 12;
/// The same in the columns of the responses, with which an iteration has exact residuals.
constexpr double refined_column = 1e-9;

std::vector<std::vector<int>> electrodes_in(const Solid& solid, model::Linearisation kind) {
  std::vector<std::vector<int>> nodes;
  if (kind == model::Linearisation::velocity) return nodes;
  for (const FloatingElectrode& electrode : solid.data().floating) nodes.push_back(electrode.nodes);
  return nodes;
}

std::string name_with(math::Ordering ordering) { return "solid ldlt (" + std::string(name_of(ordering)) + ")"; }

int block_size_of(const Solid& solid, model::Linearisation kind) {
  return solid.unknowns().n_free_potentials() > 0 && kind != model::Linearisation::velocity ? 4 : 3;
}

/// Muscles are many and small: their factors are read from memory in every iteration, and these have exact residuals.
math::FactorStorage storage_of(const Solid& solid, model::Linearisation kind) {
  return solid.ties().empty() || kind != model::Linearisation::step ? math::FactorStorage::double_precision
                                                                    : math::FactorStorage::single_precision;
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

}  // namespace

SolidSolver::SolidSolver(const Solid& solid, model::Linearisation kind)
    : solid_(solid),
      kind_(kind),
      pattern_(solid.elements().n_nodes(), block_size_of(solid, kind), solid.elements().cells()),
      slots_(solid.elements().slots_in(pattern_)),
      factor_(pattern_, solid.unknowns().mask(), electrodes_in(solid, kind), storage_of(solid, kind)),
      turning_(solid.data()),
      responses_(solid.data(), factor_.matrix().n_rows(), pattern_.block_size(), solid.n_pressures(),
                 storage_of(solid, kind)),
      expected_negative_(kind == model::Linearisation::velocity ? 0 : negative_potentials(solid)) {
  const Eigen::Index n_nodes = solid.elements().n_nodes();
  rhs_ = Eigen::VectorXd::Zero(factor_.matrix().n_rows());
  for (Eigen::VectorXd* v : {&dx_, &total_x_, &force_}) *v = Eigen::VectorXd::Zero(3 * n_nodes);
  for (Eigen::VectorXd* v : {&weight_, &coupling_, &compliance_, &curvature_, &rows_, &dp_, &total_p_}) {
    *v = Eigen::VectorXd::Zero(solid.n_pressures());
  }
  total_phi_ = Eigen::VectorXd::Zero(n_nodes);
}

model::SolverSize SolidSolver::size_of(const Solid& solid, model::Linearisation kind) {
  const math::SymmetricBlockPattern pattern(solid.elements().n_nodes(), block_size_of(solid, kind),
                                            solid.elements().cells());
  const math::LdltSize size = math::LdltAnalysis(pattern, solid.unknowns().mask()).size();
  const double block = pattern.block_size();
  return {.solver = name_with(size.ordering),
          .matrix_bytes = 8.0 * block * block * pattern.n_blocks(),
          .factor_bytes = static_cast<double>(size.factor_bytes + size.work_bytes)};
}

std::string SolidSolver::name() const { return name_with(factor_.size().ordering); }

int SolidSolver::unstable_directions() const { return factor_.n_negative() - expected_negative_; }

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
  for (Eigen::Index cell = 0; cell < V.size(); ++cell) {
    const auto index = static_cast<std::size_t>(solid_.data().material_of_cell[static_cast<std::size_t>(cell)]);
    const double viscous = step ? viscosity_of(solid_.data().materials[index]) / at.dt : 0.0;
    double stiffness = augmentation * (solid_.data().shear_moduli[index] + viscous + inertia);
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
  factor_.matrix().set_zero();
  solid_.elements().tangent(solid_.fields(at), weights, {}, slots_, factor_.matrix());
}

bool SolidSolver::factorise(const model::IntervalPoint& at) {
  // The mass matrix is constant; only volumes that must not change make its equations depend on the configuration.
  const bool constant = kind_ == model::Linearisation::velocity && !solid_.is_incompressible();
  if (constant && factorised_) return true;
  if (lagged_.gradient.size() == 0 && solid_.has_pressures()) {
    lagged_.gradient = Eigen::VectorXd::Zero(24 * solid_.n_pressures());
    lagged_.J = Eigen::VectorXd::Ones(solid_.n_pressures());
  }
  assemble(at);
  factorised_ = factor_.factorise();
  turning_.keep(at.q1);
  if (factorised_ && !responses_.empty()) respond();
  return factorised_;
}

void SolidSolver::back_substitute() {
  const Eigen::Index block = pattern_.block_size();
  factor_.solve(rhs_);
  for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
    dx_.segment<3>(3 * node) = rhs_.segment<3>(block * node);
  }
  if (solid_.has_pressures()) {
    lagged_.project(solid_.elements(), dx_, dp_);
    dp_ = (coupling_.cwiseProduct(dp_) - rows_).cwiseQuotient(compliance_);
  }
}

void SolidSolver::respond() {
  Eigen::MatrixXd& W = responses_.displacements();
  responses_.impose();
  if (exact() && solid_.is_incompressible()) {
    respond_exactly();
  } else {
    imposed_ = W;
    for (Eigen::Index j = 0; j < W.cols(); ++j) factor_.matrix().multiply(imposed_.col(j), W.col(j));
    factor_.solve_columns(W);
    W = imposed_ - W;
    for (Eigen::Index j = 0; j < W.cols() && solid_.has_pressures(); ++j) {
      for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
        dx_.segment<3>(3 * node) = W.col(j).segment<3>(pattern_.block_size() * node);
      }
      lagged_.project(solid_.elements(), dx_, dp_);
      responses_.pressures().col(j) = coupling_.cwiseProduct(dp_).cwiseQuotient(compliance_);
    }
  }
  responses_.condense(factor_.matrix());
}

void SolidSolver::respond_exactly() {
  refined_ = refined_column;
  const Eigen::Index block = pattern_.block_size();
  Eigen::MatrixXd& W = responses_.displacements();
  for (Eigen::Index j = 0; j < W.cols(); ++j) {
    factor_.matrix().multiply(W.col(j), rhs_);
    for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
      dx_.segment<3>(3 * node) = W.col(j).segment<3>(block * node);
      force_.segment<3>(3 * node) = -rhs_.segment<3>(block * node);
      if (block == 4) rhs_[4 * node + potential_bit] *= -1.0;
    }
    lagged_.project(solid_.elements(), dx_, rows_);
    rows_ = -coupling_.cwiseProduct(rows_);
    // The matrix holds the eliminated pressures, which solve() adds once more.
    dp_ = -coupling_.cwiseProduct(rows_).cwiseQuotient(compliance_);
    lagged_.add_gradients(solid_.elements(), dp_, force_);
    solve();
    for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
      W.col(j).segment<3>(block * node) += total_x_.segment<3>(3 * node);
      if (block == 4) W(4 * node + potential_bit, j) += total_phi_[node];
    }
    responses_.pressures().col(j) = total_p_;
  }
  refined_ = refined;
}

void SolidSolver::reduce(const Eigen::VectorXd& bracket, const Eigen::VectorXd& h) {
  const Eigen::Index block = pattern_.block_size();
  force_ = solid_.positions(bracket);
  if (turning_.is_turned()) turning_.back(force_);
  if (solid_.has_pressures()) rows_ = solid_.pressures(h);
  for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
    if (block == 4) rhs_[4 * node + potential_bit] = potential_rows_ * h[solid_.y_slice().first + node];
  }
  if (!responses_.empty()) {
    for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
      rhs_.segment<3>(block * node) = force_.segment<3>(3 * node);
    }
    responses_.answer(turning_, rhs_, rows_);
  }
  solve();
}

void SolidSolver::solve() {
  const Eigen::Index block = pattern_.block_size();
  if (solid_.has_pressures()) {
    dp_ = coupling_.cwiseProduct(rows_).cwiseQuotient(compliance_);
    lagged_.add_gradients(solid_.elements(), dp_, force_);
  }
  for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
    rhs_.segment<3>(block * node) = force_.segment<3>(3 * node);
  }
  back_substitute();
  total_x_ = dx_;
  total_p_ = dp_;
  total_phi_.setZero();
  if (block == 4) {
    for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) total_phi_[node] = rhs_[4 * node + potential_bit];
  }
  if (exact() && solid_.is_incompressible()) refine();
}

/// What the compliance of the factor has let through is given back until the volume rows hold exactly.
void SolidSolver::refine() {
  const Eigen::Index block = pattern_.block_size();
  const double first = dp_.lpNorm<Eigen::Infinity>();
  for (int i = 0; i < max_refinements && dp_.lpNorm<Eigen::Infinity>() > refined_ * first; ++i) {
    rows_ = -compliance_.cwiseProduct(dp_);
    force_.setZero();
    dp_ = coupling_.cwiseProduct(rows_).cwiseQuotient(compliance_);
    lagged_.add_gradients(solid_.elements(), dp_, force_);
    rhs_.setZero();
    for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
      rhs_.segment<3>(block * node) = force_.segment<3>(3 * node);
    }
    back_substitute();
    total_x_ += dx_;
    total_p_ += dp_;
    if (block == 4) {
      for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) total_phi_[node] += rhs_[4 * node + potential_bit];
    }
  }
}

void SolidSolver::add_motion_of_bodies(const Eigen::VectorXd& dq) {
  const Eigen::Index block = pattern_.block_size();
  responses_.read_bodies(turning_, dq);
  rhs_.setZero();
  responses_.add_displacements(rhs_);
  for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
    total_x_.segment<3>(3 * node) += rhs_.segment<3>(block * node);
    if (block == 4) total_phi_[node] += rhs_[4 * node + potential_bit];
  }
  if (solid_.has_pressures()) responses_.add_pressures(total_p_);
}

void SolidSolver::expand(Eigen::VectorXd& dq, Eigen::VectorXd& dy) {
  if (!responses_.empty()) add_motion_of_bodies(dq);
  if (turning_.is_turned()) turning_.forth(total_x_);
  solid_.positions(dq) = total_x_;
  if (dy.size() == 0) return;
  if (solid_.n_potentials() > 0) solid_.potentials(dy) = total_phi_;
  if (solid_.has_pressures()) solid_.pressures(dy) = total_p_;
}

}  // namespace muldi::fem
