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
    result.sentence = "no stable equilibrium at the first load";
    if (!report.inadmissible.empty()) result.sentence += ": " + report.inadmissible;
  }
  result.last_good = options_.from;
  result.first_bad = options_.from;
  return false;
}

SweepResult Sweep::run(StaticState& state, const SweepCallbacks& callbacks) {
  return options_.continuation == Continuation::natural ? natural(state, callbacks) : arc_length(state, callbacks);
}

FollowedStep Sweep::follow(double load, double next, StaticState& state, EquilibriumReport& report) {
  const double range = options_.to - options_.from;
  const bool resolved = std::abs(next - load) <= bracket_width * std::abs(range);
  Eigen::VectorXd moved(model_.manifold->n_v());
  controls_at(load);
  solver_.linearise(state, u_);
  const double predicted = moved.size() > 0 ? std::abs(next - load) * response_length() : 0.0;
  const StaticState start = state;
  double predicted_parts = 0.0;
  if (!model_.substructures.empty()) {
    controls_at(next);
    predicted_parts = solver_.predict(state, u_);
  }
  if (predicted_parts > longest_prediction && !resolved) return {};
  const StaticState guess = state;
  report = solve_at(next, state);
  model_.manifold->difference(start.x, state.x, moved);
  const double travelled = moved.cwiseQuotient(solver_.scale()).norm();
  const bool left =
      solver_.distance(state, guess) > largest_correction * std::max(predicted_parts, smallest_prediction);
  const bool jumps = is_jump(travelled, predicted);
  const bool leaves = jumps || left;
  if (!report.converged || report.stability != Stability::stable || (leaves && !resolved)) return {};
  return {.accepted = true, .leaves_branch = leaves, .jumps = jumps};
}

double Sweep::response_length() {
  StaticMotion newton;
  StaticMotion response;
  solver_.motions(u_, direction_, newton, response);
  return response.w.cwiseQuotient(solver_.scale()).norm();
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
      if (const FollowedStep taken = follow(load, next, trial, report); taken.accepted) {
        if (taken.leaves_branch) result.changes.push_back({.before = load, .after = next, .jumps = taken.jumps});
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
      if (!report.inadmissible.empty()) result.sentence += ": " + report.inadmissible;
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

SweepResult Sweep::arc_length(StaticState& state, const SweepCallbacks& callbacks) {
  SweepResult result;
  EquilibriumReport report;
  if (!first_equilibrium(state, report, result)) return result;
  record(callbacks, options_.from, state, report);
  const double range = options_.to - options_.from;
  const double nominal = 1.0 / options_.steps;
  const int most_points = 100 * options_.steps;
  ArcLength curve(solver_, u_fixed_, direction_, range, options_.equilibrium);
  CurvePoint here = curve.start(state, options_.from);
  double arc = nominal;
  for (int point = 0; point < most_points; ++point) {
    if (callbacks.interrupted && callbacks.interrupted()) {
      result.end = SweepResult::End::interrupted;
      return result;
    }
    CurvePoint next;
    while (!curve.advance(here, arc, next)) {
      arc *= 0.5;
      if (arc > bracket_width) continue;
      result.last_good = here.load;
      if (next.report.inadmissible.empty()) {
        result.end = SweepResult::End::no_convergence;
        result.sentence = base::format("the curve could not be followed beyond the load {:.10g}", here.load);
      } else {
        result.sentence = base::format("the curve ends at the load {:.10g}: {}", here.load, next.report.inadmissible);
      }
      return result;
    }
    const double progress = (next.load - options_.from) / range;
    const bool leaves = progress > 1.0 || progress < 0.0;
    // The curve leaves the swept range: end on its border.
    if (leaves && !curve.move_to(progress > 1.0 ? options_.to : options_.from, next)) break;
    state = next.state;
    controls_at(next.load);
    record(callbacks, next.load, state, next.report);
    CriticalPoint critical;
    if (curve.locate(here, next, arc, critical)) result.critical.push_back(critical);
    here = std::move(next);
    if (leaves) break;
    if (const std::string end = model_.unresolved(here.state.q); !end.empty()) {
      result.sentence = base::format("the curve ends at the load {:.10g}: {}", here.load, end);
      break;
    }
    if (here.report.iterations <= 4) arc = std::min(2.0 * arc, nominal);
  }
  result.last_good = here.load;
  return result;
}

}  // namespace muldi::statics
