#include "variational/explicit_stepper.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "variational/control_rates.hpp"

namespace muldi::variational {
namespace {

constexpr long steps_between_checks = 1000;
constexpr int most_lanczos_steps = 60;
constexpr double eigenvalue_accuracy = 1e-3;
/// Of the part's size: differences of forces, of second order.
constexpr double difference_step = 1e-5;

/// Keeps what the substructures remember, which evaluations beside the run would change.
class MemoryGuard {
 public:
  explicit MemoryGuard(const model::Model& model) : model_(model) {
    for (const auto& part : model.substructures) {
      memories_.emplace_back(part->n_memory());
      part->store_memory(memories_.back());
    }
  }
  ~MemoryGuard() {
    for (std::size_t k = 0; k < memories_.size(); ++k) model_.substructures[k]->restore_memory(memories_[k]);
  }
  MemoryGuard(const MemoryGuard&) = delete;
  MemoryGuard& operator=(const MemoryGuard&) = delete;

 private:
  const model::Model& model_;
  std::vector<Eigen::VectorXd> memories_;
};

}  // namespace

ExplicitStepper::ExplicitStepper(const model::Model& model, double dt)
    : model_(model),
      dt_(dt),
      mass_(model, model::Linearisation::velocity, "auto"),
      unused_(*model.pattern),
      u_last_(model.controls.size()),
      u_end_(model.controls.size()) {
  for (Eigen::VectorXd* in_q :
       {&forces_.force, &forces_.momentum, &q_, &q_mid_, &v_, &dv_, &force_, &bracket_, &constraint_force_}) {
    *in_q = Eigen::VectorXd::Zero(model.n_q());
  }
  for (Eigen::VectorXd* in_y : {&forces_.stage, &y_, &dy_, &zero_y_}) *in_y = Eigen::VectorXd::Zero(model.n_y());
}

void ExplicitStepper::evaluate(const Eigen::VectorXd& q, std::span<const double> u, const Eigen::VectorXd& y) {
  model_.forces({.q0 = q, .q1 = q, .q = q, .v = v_, .u = u, .y = &y}, forces_);
}

void ExplicitStepper::solve_mass(Eigen::VectorXd& rows, Eigen::VectorXd& dv) {
  mass_.keep_free(rows);
  mass_.eliminate(rows, zero_y_, unused_);
  mass_.complete(dv, dy_);
}

void ExplicitStepper::settle(const Eigen::VectorXd& q, std::span<const double> u, Eigen::VectorXd& y) {
  mass_.settle_stage({.q0 = q, .q1 = q, .q = q, .v = v_, .u = u, .y = &y}, y);
}

StepReport ExplicitStepper::advance(State& state, std::span<const double> u) {
  StepReport report;
  if (!mass_.factorised()) {
    v_.setZero();
    ++report.factorisations;
    if (!mass_.factorise({.q0 = state.q, .q1 = state.q, .q = state.q, .v = v_, .u = {}})) {
      report.status = Status::no_convergence;
      report.sentence = "the mass matrix is singular";
      return report;
    }
  }
  if (!checked_ || state.step % steps_between_checks == 0) {
    checked_ = true;
    const double stable = stable_step(state, u);
    if (!(dt_ < stable)) {
      report.status = Status::step_too_large;
      report.sentence = base::format(
          "the explicit integrator is stable for steps below {:.4g} (2/omega of the fastest wave in the mesh), the "
          "step "
          "is {:.4g}: use a smaller one, or integrator: midpoint",
          stable, dt_);
      return report;
    }
  }
  model_.evaluate_controls(state.t + (1.0 - before_end) * dt_, u_end_);
  if (state.step > 0) model_.evaluate_controls(state.t - 0.5 * dt_, u_last_);
  q_ = state.q;
  y_ = state.y;
  mass_.place({.u = u, .u_end = u_end_}, q_, y_);
  if (state.step == 0 || !std::equal(u.begin(), u.end(), u_last_.begin())) settle(state.q, u, y_);

  // What is prescribed has its velocity; the rest follows from M v = p + dt/2 F.
  v_ = (q_ - state.q) / dt_;
  evaluate(state.q, u, y_);
  force_ = forces_.force;
  bracket_ = state.p + 0.5 * dt_ * force_ - forces_.momentum;
  solve_mass(bracket_, dv_);
  v_ += dv_;
  q_ = state.q + dt_ * v_;
  mass_.place({.u = u, .u_end = u_end_}, q_, y_);
  settle(q_, u, y_);
  evaluate(q_, u, y_);
  if (!(forces_.margin > 0.0) || !q_.allFinite()) {
    report.status = Status::inverted_element;
    report.sentence = model_.inadmissible_anywhere(q_);
    return report;
  }
  const double weight = state.step == 0 ? 0.5 * dt_ : dt_;
  constraint_force_ = -(state.p + 0.5 * dt_ * force_ - forces_.momentum) / weight;
  report.iterations = 1;
  q_mid_ = 0.5 * (state.q + q_);
  report.work = model_.work(
      {.q0 = state.q, .q1 = q_, .q = q_mid_, .v = v_, .u = u, .dt = dt_, .y = &y_, .first = state.step == 0});
  state.p = forces_.momentum + 0.5 * dt_ * forces_.force;
  state.advance = q_ - state.q;
  state.q = q_;
  state.y = y_;
  ++state.step;
  state.t = static_cast<double>(state.step) * dt_;
  return report;
}

void ExplicitStepper::mass_along(const State& state, std::span<const double> u, const Eigen::VectorXd& along,
                                 Eigen::VectorXd& out) {
  v_ = along;
  model_.forces({.q0 = state.q, .q1 = state.q, .q = state.q, .v = v_, .u = u}, forces_);
  out = forces_.momentum;
  mass_.keep_free(out);
}

void ExplicitStepper::settled_forces(const Eigen::VectorXd& q, std::span<const double> u, Eigen::VectorXd& rows) {
  v_.setZero();
  settle(q, u, y_);
  evaluate(q, u, y_);
  rows = forces_.force;
  mass_.keep_free(rows);
}

void ExplicitStepper::stiffness_along(const State& state, std::span<const double> u, const Eigen::VectorXd& along,
                                      Eigen::VectorXd& out) {
  const double size = mass_.size_of(along, zero_y_).largest();
  const double h = size > 0.0 ? difference_step / size : 0.0;
  Eigen::VectorXd ahead(state.q.size());
  settled_forces(state.q + h * along, u, ahead);
  settled_forces(state.q - h * along, u, out);
  out = (out - ahead) / (2.0 * h);
}

double ExplicitStepper::stable_step(const State& state, std::span<const double> u) {
  const MemoryGuard guard(model_);
  v_.setZero();
  if (!mass_.factorised()) mass_.factorise({.q0 = state.q, .q1 = state.q, .q = state.q, .v = v_, .u = {}});
  y_ = state.y;
  Eigen::VectorXd placed = state.q;
  mass_.place({.u = u, .u_end = u}, placed, y_);
  // A start that no symmetry of the mesh excludes from the fastest waves, and no chance decides on.
  Eigen::VectorXd x(model_.n_q());
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = std::cos(2.4 * static_cast<double>(i * i % 1009) + 0.3);
  mass_.keep_free(x);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(x.size());
  Eigen::VectorXd Mx(x.size());
  Eigen::VectorXd Kx(x.size());
  Eigen::VectorXd next(x.size());
  mass_along(state, u, x, Mx);
  x /= std::sqrt(x.dot(Mx));
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(most_lanczos_steps);
  Eigen::VectorXd off = diagonal;
  double largest = 0.0;
  for (int k = 0; k < most_lanczos_steps; ++k) {
    stiffness_along(state, u, x, Kx);
    diagonal[k] = x.dot(Kx);
    solve_mass(Kx, next);
    next -= diagonal[k] * x + (k > 0 ? off[k - 1] : 0.0) * before;
    mass_along(state, u, next, Mx);
    off[k] = std::sqrt(std::max(0.0, next.dot(Mx)));
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
    eigen.computeFromTridiagonal(diagonal.head(k + 1), off.head(k));
    const double bound = off[k] * std::abs(eigen.eigenvectors()(k, k));
    largest = eigen.eigenvalues()[k] + bound;
    if (bound <= eigenvalue_accuracy * largest || off[k] == 0.0) break;
    before = x;
    x = next / off[k];
  }
  return largest > 0.0 ? 2.0 / std::sqrt(largest) : std::numeric_limits<double>::infinity();
}

}  // namespace muldi::variational
