#include "statics/sweep.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"

namespace muldi::statics {
namespace {

/// The critical load is bracketed to this fraction of the swept range.
constexpr double bracket_width = 1e-6;
/// A corrector longer than the predictor (dimensionless) means a jump to another branch.
constexpr double longest_correction = 1.0;
constexpr double smallest_prediction = 1e-3;
/// Substructures may leave their branch on longer predictions (in sizes of the part), and have left it where the
/// corrector is a larger part of the predictor than this.
constexpr double longest_prediction = 0.1;
constexpr double largest_correction = 0.5;

/// True if an equilibrium lies so far from the predicted one that it belongs to another branch.
bool is_jump(double travelled, double predicted) {
  return travelled - predicted > longest_correction * std::max(predicted, smallest_prediction) &&
         travelled > 10.0 * smallest_prediction;
}

}  // namespace

Sweep::Sweep(const model::Model& model, std::vector<double> u_fixed, std::vector<double> direction,
             SweepOptions options)
    : model_(model),
      u_fixed_(std::move(u_fixed)),
      direction_(std::move(direction)),
      options_(std::move(options)),
      solver_(model, options_.equilibrium),
      u_(u_fixed_.size()) {}

void Sweep::controls_at(double load) {
  for (std::size_t c = 0; c < u_.size(); ++c) u_[c] = u_fixed_[c] + load * direction_[c];
}

EquilibriumReport Sweep::solve_at(double load, StaticState& state) {
  controls_at(load);
  return solver_.solve(state, u_);
}

void Sweep::record(const SweepCallbacks& callbacks, double load, const StaticState& state,
                   const EquilibriumReport& report) {
  if (!callbacks.record) return;
  callbacks.record({.load = load,
                    .state = state,
                    .q = solver_.configuration(),
                    .y = solver_.stage(),
                    .force = solver_.force(),
                    .u = u_,
                    .report = report});
}

bool Sweep::first_equilibrium(StaticState& state, EquilibriumReport& report, SweepResult& result) {
  report = solve_at(options_.from, state);
  if (report.converged && report.stability == Stability::stable) return true;
  if (report.converged && report.stability == Stability::free) {
    result.end = SweepResult::End::free_motion;
    result.sentence =
        "the system can move without any force: hold it by joints, springs or muscles before asking for its "
        "equilibrium";
  } else {
    result.end = SweepResult::End::loss_of_equilibrium;
    result.sentence = report.inadmissible.empty() ? "no stable equilibrium at the first load" : report.inadmissible;
  }
  result.last_good = options_.from;
  result.first_bad = options_.from;
  return false;
}

SweepResult Sweep::run(StaticState& state, const SweepCallbacks& callbacks) {
  return options_.continuation == Continuation::natural ? natural(state, callbacks) : arc_length(state, callbacks);
}

bool Sweep::follow(double load, double next, StaticState& state, EquilibriumReport& report) {
  const double range = options_.to - options_.from;
  const bool resolved = std::abs(next - load) <= bracket_width * std::abs(range);
  Eigen::VectorXd moved(model_.manifold->n_v());
  controls_at(load);
  solver_.linearise(state, u_);
  const Eigen::VectorXd tangent = tangent_at(Eigen::VectorXd());
  const double predicted = std::abs((next - load) / range) * tangent.head(moved.size()).norm() /
                           std::max(std::abs(tangent[moved.size()]), 1e-300);
  const StaticState start = state;
  double predicted_parts = 0.0;
  if (!model_.substructures.empty()) {
    controls_at(next);
    predicted_parts = solver_.predict(state, u_);
  }
  if (predicted_parts > longest_prediction && !resolved) return false;
  const StaticState guess = state;
  report = solve_at(next, state);
  model_.manifold->difference(start.x, state.x, moved);
  const double travelled = moved.cwiseQuotient(solver_.scale()).norm();
  const bool left =
      solver_.distance(state, guess) > largest_correction * std::max(predicted_parts, smallest_prediction);
  const bool jumped = !resolved && (is_jump(travelled, predicted) || left);
  return report.converged && report.stability == Stability::stable && !jumped;
}

SweepResult Sweep::natural(StaticState& state, const SweepCallbacks& callbacks) {
  SweepResult result;
  EquilibriumReport report;
  if (!first_equilibrium(state, report, result)) return result;
  record(callbacks, options_.from, state, report);
  const double range = options_.to - options_.from;
  double load = options_.from;
  double step = range / options_.steps;
  for (int k = 1; k <= options_.steps; ++k) {
    const double goal = k == options_.steps ? options_.to : options_.from + range * k / options_.steps;
    while (load != goal) {
      if (callbacks.interrupted && callbacks.interrupted()) {
        result.end = SweepResult::End::interrupted;
        return result;
      }
      const bool last = std::abs(step) >= std::abs(goal - load);
      const double next = last ? goal : load + step;
      StaticState trial = state;
      if (follow(load, next, trial, report)) {
        state = trial;
        load = next;
        step = std::copysign(std::min(2.0 * std::abs(step), std::abs(range / options_.steps)), range);
        continue;
      }
      step = 0.5 * (next - load);
      if (std::abs(step) > 0.5 * bracket_width * std::abs(range)) continue;
      result.end = SweepResult::End::loss_of_equilibrium;
      result.last_good = load;
      result.first_bad = next;
      result.sentence = base::format("the equilibrium is lost at a load between {:.10g} and {:.10g}", load, next);
      report = solve_at(load, state);
      record(callbacks, load, state, report);
      return result;
    }
    controls_at(load);
    solver_.linearise(state, u_);
    record(callbacks, load, state, report);
  }
  result.last_good = load;
  return result;
}

// ---- pseudo-arc-length (Keller): unknowns (w / scale, load / range), orthogonal to the tangent of the last point
// --------

Eigen::MatrixXd Sweep::bordered(const Eigen::VectorXd& tangent) {
  const Eigen::Index n_v = solver_.tangent().rows();
  const Eigen::Index n_c = solver_.loop_rows().rows();
  const Eigen::VectorXd& scale = solver_.scale();
  const double range = options_.to - options_.from;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n_v + n_c + 1, n_v + n_c + 1);
  matrix.topLeftCorner(n_v, n_v) = scale.asDiagonal() * solver_.tangent() * scale.asDiagonal();
  matrix.block(0, n_v, n_v, 1) = -range * scale.cwiseProduct(solver_.load_rate(u_, direction_));
  matrix.block(0, n_v + 1, n_v, n_c) = (solver_.loop_rows() * scale.asDiagonal()).transpose();
  matrix.block(n_v, 0, n_c, n_v) = solver_.loop_rows() * scale.asDiagonal();
  matrix.row(n_v + n_c).head(n_v + 1) = tangent.transpose();
  return matrix;
}

Eigen::VectorXd Sweep::tangent_at(const Eigen::VectorXd& previous) {
  const Eigen::Index n_v = solver_.tangent().rows();
  const Eigen::Index n_c = solver_.loop_rows().rows();
  Eigen::VectorXd border = previous;
  if (border.size() == 0) border = Eigen::VectorXd::Unit(n_v + 1, n_v);
  Eigen::VectorXd rhs = Eigen::VectorXd::Unit(n_v + n_c + 1, n_v + n_c);
  const Eigen::VectorXd solution = bordered(border).partialPivLu().solve(rhs);
  return solution.head(n_v + 1).normalized();
}

bool Sweep::corrector(StaticState& at, double& load, const Eigen::VectorXd& tangent, double arc,
                      EquilibriumReport& report) {
  const Eigen::VectorXd& scale = solver_.scale();
  const Eigen::Index n_v = scale.size();
  const Eigen::Index n_c = solver_.gaps().size();
  const double range = options_.to - options_.from;
  const StaticState start = at;
  const double start_load = load;
  Eigen::VectorXd moved(n_v);
  model_.manifold->retract(start.x, arc * scale.cwiseProduct(tangent.head(n_v)), at.x);
  load += arc * range * tangent[n_v];
  for (report.iterations = 1; report.iterations <= options_.equilibrium.max_iterations; ++report.iterations) {
    Eigen::VectorXd q(model_.manifold->n_q());
    model_.manifold->configuration(at.x, q);
    report.inadmissible = model_.inadmissible(q);
    if (!report.inadmissible.empty()) return false;
    controls_at(load);
    solver_.linearise(at, u_);
    model_.manifold->difference(start.x, at.x, moved);
    const double travelled =
        tangent.head(n_v).dot(moved.cwiseQuotient(scale)) + tangent[n_v] * (load - start_load) / range;
    Eigen::VectorXd rhs(n_v + n_c + 1);
    rhs << scale.cwiseProduct(solver_.residual()), -solver_.gaps(), arc - travelled;
    const Eigen::VectorXd increment = bordered(tangent).partialPivLu().solve(rhs);
    const double size = increment.head(n_v + 1).lpNorm<Eigen::Infinity>();
    if (!std::isfinite(size) || size > 1.0) return false;
    model_.manifold->retract(at.x, scale.cwiseProduct(increment.head(n_v)), at.x);
    load += range * increment[n_v];
    at.multipliers += solver_.loop_basis() * increment.tail(n_c);
    if (size <= options_.equilibrium.tolerance) {
      controls_at(load);
      solver_.linearise(at, u_);
      at.multipliers = solver_.least_norm(at.multipliers);
      report.converged = true;
      report.stability = solver_.stability();
      return true;
    }
  }
  return false;
}

SweepResult Sweep::arc_length(StaticState& state, const SweepCallbacks& callbacks) {
  SweepResult result;
  EquilibriumReport report;
  if (!first_equilibrium(state, report, result)) return result;
  record(callbacks, options_.from, state, report);
  const double range = options_.to - options_.from;
  const double nominal = 1.0 / options_.steps;
  const int most_points = 100 * options_.steps;
  double arc = nominal;
  double load = options_.from;
  Eigen::VectorXd tangent = tangent_at(Eigen::VectorXd());
  for (int point = 0; point < most_points; ++point) {
    if (callbacks.interrupted && callbacks.interrupted()) {
      result.end = SweepResult::End::interrupted;
      return result;
    }
    StaticState trial = state;
    double trial_load = load;
    report = {};
    while (!corrector(trial, trial_load, tangent, arc, report)) {
      trial = state;
      trial_load = load;
      arc *= 0.5;
      if (arc > bracket_width) continue;
      result.last_good = load;
      if (report.inadmissible.empty()) {
        result.end = SweepResult::End::no_convergence;
        result.sentence = base::format("the curve could not be followed beyond the load {:.10g}", load);
      } else {
        result.sentence = base::format("the curve ends at the load {:.10g}: {}", load, report.inadmissible);
      }
      return result;
    }
    const double progress = (trial_load - options_.from) / range;
    if (progress > 1.0 || progress < 0.0) {
      // The curve leaves the swept range: end on its border, by a corrector at fixed load.
      const double border = progress > 1.0 ? options_.to : options_.from;
      const Eigen::VectorXd along_load = Eigen::VectorXd::Unit(tangent.size(), tangent.size() - 1);
      report = {};
      if (corrector(trial, trial_load, along_load, (border - trial_load) / range, report)) {
        state = trial;
        load = border;
        record(callbacks, load, state, report);
      }
      break;
    }
    state = trial;
    load = trial_load;
    record(callbacks, load, state, report);
    tangent = tangent_at(tangent);
    if (report.iterations <= 4) arc = std::min(2.0 * arc, nominal);
  }
  result.last_good = load;
  return result;
}

}  // namespace muldi::statics
