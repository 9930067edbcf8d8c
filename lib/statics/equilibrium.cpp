#include "statics/equilibrium.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace muldi::statics {
namespace {

constexpr double longest_increment = 0.5;     // dimensionless: rad, or sizes of the scene
constexpr double longest_displacement = 0.1;  // of a substructure, in its sizes: nodes close to each other move by it
constexpr int max_halvings = 30;
constexpr int most_probes = 40;           // increments beyond a failure, to see what they lead to
constexpr double line_search_goal = 0.9;  // |work of the residual along the increment| relative to the start
constexpr double free_motion = 1e-11;     // smallest over largest eigenvalue of a motion without stiffness
constexpr double round_off_residual = 1e-12;
constexpr double no_load = 1e-6;  // relative residual of an equilibrium where only round-off acts

/// Columns that span the motions which the loop rows allow.
Eigen::MatrixXd admissible_motions(const Eigen::MatrixXd& B, Eigen::Index n_v) {
  if (B.rows() == 0) return Eigen::MatrixXd::Identity(n_v, n_v);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(B.transpose());
  return Eigen::MatrixXd(qr.householderQ()).rightCols(n_v - B.rows());
}

}  // namespace

EquilibriumSolver::EquilibriumSolver(const model::Model& model, EquilibriumOptions options)
    : model_(model),
      manifold_(*model.manifold),
      options_(std::move(options)),
      parts_(model, model::Linearisation::rest, options_.substructures),
      frame_(manifold_.make_frame()),
      K_(*model.pattern),
      q_(Eigen::VectorXd::Zero(model.n_q())),
      zero_(q_),
      force_(q_),
      bracket_(q_),
      r_(Eigen::VectorXd::Zero(manifold_.n_v())),
      diagonal_(r_),
      gaps_(Eigen::VectorXd::Zero(manifold_.n_loop_rows())),
      g_(Eigen::VectorXd::Zero(manifold_.n_c())),
      scale_(manifold_.rate_scale()),
      A_(manifold_.n_v(), manifold_.n_v()),
      B_(manifold_.n_c(), manifold_.n_v()),
      step_{.w = r_, .multipliers = gaps_} {
  forces_.force = q_;
  forces_.momentum = q_;
  forces_.on_rates = r_;
  if (parts_.empty()) return;
  forces_.begin = forces_.end = step_.q = before_ = excess_ = q_;
  forces_.stage = y_ = step_.y = Eigen::VectorXd::Zero(model.n_y());
}

model::IntervalPoint EquilibriumSolver::point(const StaticState& state, std::span<const double> u) const {
  const std::span<const double> x(state.x.data(), static_cast<std::size_t>(state.x.size()));
  return {.q0 = q_, .q1 = q_, .q = q_, .v = zero_, .u = u, .x0 = x, .x1 = x, .y = &y_};
}

void EquilibriumSolver::evaluate(const StaticState& state, std::span<const double> u) {
  linearised_.u.clear();
  manifold_.configuration(state.x, q_);
  if (!parts_.empty()) {
    parts_.copy_slices(state.q, q_);
    y_ = state.y;
    parts_.place({.u = u, .u_end = u}, q_, y_);
  }
  manifold_.update(state.x, q_, *frame_);
  manifold_.choose_loop_rows(*frame_);
  model_.forces(point(state, u), forces_);
  force_ = forces_.force;
  manifold_.add_forces_on_rates(*frame_, 1.0, forces_.on_rates, force_);
  // The largest force seen: at equilibrium the forces on a single unknown cancel, and their sum measures nothing.
  terms_ = std::max(terms_, force_.lpNorm<Eigen::Infinity>());
  bracket_ = forces_.force;
  manifold_.add_constraint_forces(q_, -1.0, state.multipliers, bracket_);
  parts_.gather(bracket_);
  parts_.keep_free(bracket_);
  project_bracket();
  manifold_.constraints(q_, gaps_);
  g_ = loop_basis().transpose() * gaps_;
}

void EquilibriumSolver::project_bracket() {
  manifold_.project(*frame_, bracket_, r_);
  r_ += forces_.on_rates;
}

void EquilibriumSolver::linearise(const StaticState& state, std::span<const double> u) {
  if (is_linearised_at(state, u)) return;
  evaluate(state, u);
  measure_residual();
  model_.tangent(point(state, u), model::TangentWeights::stiffness(), K_);
  total_ = bracket_;
  if (!parts_.empty()) {
    singular_ = !parts_.factorise(point(state, u));
    if (!singular_) parts_.eliminate(bracket_, forces_.stage, K_);
    project_bracket();
  }
  manifold_.project_tangent(*frame_, *frame_, K_, A_);
  model_.rate_tangent(point(state, u), model::TangentWeights::stiffness(), diagonal_);
  A_.diagonal() += diagonal_;
  manifold_.add_curvature(*frame_, total_, state.multipliers, A_);
  manifold_.project_constraints(*frame_, loop_basis(), B_);
  linearised_ = {.state = state, .u = {u.begin(), u.end()}};
}

bool EquilibriumSolver::is_linearised_at(const StaticState& state, std::span<const double> u) const {
  const StaticState& last = linearised_.state;
  return !parts_.empty() && !linearised_.u.empty() && std::equal(u.begin(), u.end(), linearised_.u.begin()) &&
         last.x == state.x && last.multipliers == state.multipliers && last.y == state.y && last.q == state.q;
}

Stability EquilibriumSolver::stability() const {
  if (singular_) return Stability::free;
  if (parts_.unstable_directions() > 0) return Stability::unstable;
  if (manifold_.n_v() == manifold_.n_c()) return Stability::stable;
  const Eigen::MatrixXd scaled = scale_.asDiagonal() * A_ * scale_.asDiagonal();
  const Eigen::MatrixXd N = admissible_motions(B_ * scale_.asDiagonal(), manifold_.n_v());
  const Eigen::MatrixXd reduced = N.transpose() * (0.5 * (scaled + scaled.transpose())) * N;
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(reduced, Eigen::EigenvaluesOnly).eigenvalues();
  const double largest = std::max(std::abs(values[0]), std::abs(values[values.size() - 1]));
  if (std::abs(values[0]) <= free_motion * largest || largest == 0.0) return Stability::free;
  return values[0] > 0.0 ? Stability::stable : Stability::unstable;
}

void EquilibriumSolver::measure_residual() {
  const double largest = std::max(r_.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>(), parts_.largest_row(bracket_));
  residual_ = terms_ > 0.0 ? largest / terms_ : 0.0;
}

double EquilibriumSolver::length_of(const StaticMotion& motion) const {
  double length = motion.w.size() > 0 ? motion.w.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>() : 0.0;
  length /= longest_increment;
  if (parts_.empty()) return length;
  return std::max(length, parts_.size_of(motion.q, motion.y).positions / longest_displacement);
}

void EquilibriumSolver::scale_increment(double factor) {
  step_.w *= factor;
  if (parts_.empty()) return;
  step_.multipliers *= factor;
  step_.q *= factor;
  step_.y *= factor;
}

void EquilibriumSolver::newton_increment() {
  // In dimensionless increments; a shift makes the tangent positive where it is not, so that steps go downhill.
  const Eigen::Index n_v = manifold_.n_v();
  const Eigen::Index n_c = manifold_.n_c();
  const Eigen::MatrixXd scaled = scale_.asDiagonal() * A_ * scale_.asDiagonal();
  const Eigen::MatrixXd rows = B_ * scale_.asDiagonal();
  const Eigen::MatrixXd N = admissible_motions(rows, n_v);
  const Eigen::MatrixXd reduced = N.transpose() * scaled * N;
  const Eigen::MatrixXd symmetric = 0.5 * (reduced + reduced.transpose());
  const double size = symmetric.size() > 0 ? symmetric.cwiseAbs().maxCoeff() : 0.0;
  double shift = 0.0;
  while (symmetric.size() > 0) {
    const Eigen::MatrixXd shifted = symmetric + shift * Eigen::MatrixXd::Identity(symmetric.rows(), symmetric.cols());
    if (Eigen::LLT<Eigen::MatrixXd>(shifted).info() == Eigen::Success) break;
    shift = shift == 0.0 ? 1e-6 * (size > 0.0 ? size : 1.0) : 4.0 * shift;
    if (!std::isfinite(shift)) break;
  }
  Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n_v + n_c, n_v + n_c);
  kkt.topLeftCorner(n_v, n_v) = scaled + shift * Eigen::MatrixXd::Identity(n_v, n_v);
  kkt.topRightCorner(n_v, n_c) = rows.transpose();
  kkt.bottomLeftCorner(n_c, n_v) = rows;
  Eigen::VectorXd rhs(n_v + n_c);
  rhs << scale_.cwiseProduct(r_), -g_;
  const Eigen::VectorXd solution = kkt.partialPivLu().solve(rhs);
  step_.w = scale_.cwiseProduct(solution.head(n_v));
  step_.multipliers = loop_basis() * solution.tail(n_c);
  if (parts_.empty()) return;
  step_.q.setZero();
  manifold_.lift(*frame_, step_.w, step_.q);
  parts_.complete(step_.q, step_.y);
}

double EquilibriumSolver::predict(StaticState& state, std::span<const double> u) {
  evaluate(state, u);
  parts_.eliminate(bracket_, forces_.stage, K_);
  manifold_.project(*frame_, bracket_, r_);
  newton_increment();
  const double size = std::max(parts_.deformation(q_, step_.q), parts_.size_of(step_.q, step_.y).stage);
  if (!(size <= longest_increment)) return size;
  StaticState moved = state;
  swing(state, 1.0, step_, moved);
  state = std::move(moved);
  return size;
}

double EquilibriumSolver::distance(const StaticState& a, const StaticState& b) {
  if (parts_.empty()) return 0.0;
  step_.q = a.q - b.q;
  step_.y.setZero();
  return parts_.size_of(step_.q, step_.y).largest();
}

double EquilibriumSolver::line_search(const StaticState& start, StaticState& trial, std::span<const double> u,
                                      std::string& inadmissible) {
  linearised_.u.clear();
  const double begin = r_.dot(step_.w);
  double factor = 1.0;
  for (int halving = 0; halving <= max_halvings; ++halving, factor *= 0.5) {
    move(start, factor, step_, trial);
    manifold_.configuration(trial.x, q_);
    inadmissible = model_.inadmissible(q_);
    if (!inadmissible.empty()) {
      shortened_by_ = inadmissible;
      continue;
    }
    evaluate(trial, u);
    if (!(forces_.margin > 0.0)) {
      inadmissible = model_.inadmissible_anywhere(q_);
      if (inadmissible.empty()) inadmissible = "an element of a solid collapses";
      shortened_by_ = inadmissible;
      continue;
    }
    if (!parts_.empty()) return factor;
    // On loops the multipliers change with the step, so that the work of the residual is no measure of progress there.
    if (manifold_.n_c() > 0 || std::abs(r_.dot(step_.w)) <= line_search_goal * std::abs(begin)) return factor;
    if (terms_ * round_off_residual >= r_.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>()) return factor;
  }
  return inadmissible.empty() ? factor : 0.0;
}

EquilibriumReport EquilibriumSolver::solve(StaticState& state, std::span<const double> u) {
  shortened_by_.clear();
  EquilibriumReport report = iterate(state, u);
  if (!report.converged && report.inadmissible.empty()) report.inadmissible = shortened_by_;
  if (!report.converged && report.inadmissible.empty()) report.inadmissible = limit_of_increment();
  return report;
}

std::string EquilibriumSolver::limit_of_increment() {
  if (parts_.empty() || !step_.q.allFinite()) return {};
  const double length = length_of(step_);
  if (!(length > 0.0)) return {};
  linearised_.u.clear();
  // Along the last increment, in steps that are taken whole, until something gives way.
  for (int k = 1; k <= most_probes; ++k) {
    q_ += step_.q / length;
    const std::string found = model_.inadmissible_anywhere(q_);
    if (!found.empty()) return "the forces move on until " + found;
  }
  return {};
}

EquilibriumReport EquilibriumSolver::iterate(StaticState& state, std::span<const double> u) {
  EquilibriumReport report;
  StaticState at = state;
  StaticState trial = state;
  double previous = 0.0;
  linearised_.u.clear();
  manifold_.configuration(at.x, q_);
  report.inadmissible = model_.inadmissible(q_);
  if (!report.inadmissible.empty()) return report;
  if (manifold_.n_v() == 0 && parts_.empty()) {
    linearise(at, u);
    report.converged = true;
    return report;
  }
  for (report.iterations = 1; report.iterations <= options_.max_iterations; ++report.iterations) {
    linearise(at, u);
    if (singular_) return report;
    newton_increment();
    const double size = size_of(step_);
    if (!std::isfinite(size)) return report;
    const double length = length_of(step_);
    if (length > 1.0) scale_increment(1.0 / length);
    if (line_search(at, trial, u, report.inadmissible) == 0.0) return report;
    std::swap(at, trial);
    measure_residual();
    report.residual = residual_;
    const bool stagnates = report.iterations > 3 && size > 0.5 * previous && report.residual < round_off_residual;
    previous = size;
    if (size <= options_.tolerance || stagnates) {
      report.converged = true;
      break;
    }
  }
  if (!report.converged) return report;
  linearise(at, u);
  report.stability = stability();
  // Where no load acts all forces are round-off, and so is their ratio: the increment says how far the state is off.
  if (report.residual > no_load) report.residual = std::min(report.residual, previous);
  settle(at);
  state = at;
  return report;
}

}  // namespace muldi::statics
