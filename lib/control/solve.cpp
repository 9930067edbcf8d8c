#include "control/solve.hpp"

#include <chrono>
#include <cmath>
#include <map>

#include "control/nlp_solver.hpp"
#include "control/transcription.hpp"

namespace muldi::control {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Distance to a bound, relative to unknowns of size 1, below which it counts as active.
constexpr double active_distance = 1e-6;

void report_violation(Transcription& transcription, const Eigen::VectorXd& x, SolveResult& result) {
  if (!transcription.move_to(x)) return;
  result.objective = transcription.objective() / transcription.objective_factor();
  Eigen::VectorXd c;
  transcription.constraints(c);
  const NlpBounds& bounds = transcription.bounds();
  int worst = -1;
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    const double violation = std::max(bounds.c_lower[i] - c[i], c[i] - bounds.c_upper[i]);
    if (violation <= result.worst_violation) continue;
    result.worst_violation = violation;
    worst = static_cast<int>(i);
  }
  result.infeasibility = result.worst_violation;
  if (worst < 0) return;
  const Transcription::Place place = transcription.row_place(worst);
  result.worst_constraint = place.name;
  result.worst_time = place.node * result.trajectory.step;
}

void report_active(Transcription& transcription, const Eigen::VectorXd& x, SolveResult& result) {
  std::map<std::pair<std::string, bool>, std::vector<int>> active;
  const auto look = [&](double value, double lower, double upper, const Transcription::Place& place) {
    if (lower == upper || place.name.empty()) return;
    if (value - lower < active_distance) active[{place.name, false}].push_back(place.node);
    if (upper - value < active_distance) active[{place.name, true}].push_back(place.node);
  };
  const NlpBounds& bounds = transcription.bounds();
  for (int i = 0; i < transcription.n_variables(); ++i) {
    look(x[i], bounds.x_lower[i], bounds.x_upper[i], transcription.variable_place(i));
  }
  Eigen::VectorXd c;
  if (transcription.move_to(x)) {
    transcription.constraints(c);
    for (int i = 0; i < transcription.n_constraints(); ++i) {
      look(c[i], bounds.c_lower[i], bounds.c_upper[i], transcription.row_place(i));
    }
  }
  for (const auto& [key, nodes] : active) result.active.push_back({key.first, key.second, nodes});
}

}  // namespace

std::string name_of(SolveStatus status) {
  switch (status) {
    case SolveStatus::optimal:
      return "optimal";
    case SolveStatus::acceptable:
      return "acceptable";
    case SolveStatus::infeasible:
      return "infeasible";
    case SolveStatus::iteration_limit:
      return "iteration_limit";
    case SolveStatus::interrupted:
      return "interrupted";
    case SolveStatus::failed:
      return "no_convergence";
    case SolveStatus::unavailable:
      return "unavailable";
  }
  return "";
}

namespace {

/// Beyond 1 rad a step the midpoint momentum of a body no longer grows with its speed; the integrator refuses 2 rad.
constexpr double longest_turn = 1.0;
constexpr double refused_turn = 2.0;

/// The largest turn of a body in one step (rad).
double largest_turn(const Problem& problem, const Trajectory& trajectory) {
  const model::Manifold& manifold = *problem.model.manifold;
  Eigen::VectorXd q0 = Eigen::VectorXd::Zero(problem.model.n_q());
  Eigen::VectorXd q1 = q0;
  double largest = 0.0;
  for (std::size_t n = 0; n + 1 < trajectory.x.size(); ++n) {
    manifold.configuration(trajectory.x[n], q0);
    manifold.configuration(trajectory.x[n + 1], q1);
    largest = std::max(largest, manifold.largest_rotation(q0, q1));
  }
  return largest;
}

SolveResult solve_once(const Problem& problem, std::span<const WeightedObjective> objectives, const Trajectory& guess,
                       const SolveOptions& options) {
  const Clock::time_point begin = Clock::now();
  SolveResult result;
  result.trajectory = guess;
  const Trajectory start = refined_guess(problem, guess);
  Transcription transcription(problem, objectives, start);
  if (!transcription.faults().empty()) {
    const Fault& fault = transcription.faults().front();
    result.status = SolveStatus::infeasible;
    result.sentence = fault.where.empty() ? fault.why : fault.where + ": " + fault.why;
    return result;
  }
  result.n_variables = transcription.n_variables();
  result.n_constraints = transcription.n_constraints();
  const NlpSolver solver = open_nlp_solver(result.sentence);
  if (solver == nullptr) {
    result.status = SolveStatus::unavailable;
    return result;
  }
  result.times.transcription = seconds_since(begin);
  SolveOptions scaled = options;
  if (options.progress) {
    scaled.progress = [&](Iterate iterate) {
      iterate.objective /= transcription.objective_factor();
      options.progress(iterate);
    };
  }
  const NlpResult found = solver(transcription, transcription.unknowns_of(start), scaled);
  result.status = found.status;
  result.sentence = found.sentence;
  result.iterations = found.iterations;
  result.derivative_errors = found.derivative_errors;
  result.derivative_log = found.derivative_log;
  result.trajectory = transcription.trajectory_of(found.x);
  report_violation(transcription, found.x, result);
  report_active(transcription, found.x, result);
  result.times.functions = found.function_time;
  result.times.hessian = found.hessian_time;
  result.times.total = seconds_since(begin);
  return result;
}

}  // namespace

SolveResult solve(const Problem& problem, std::span<const WeightedObjective> objectives, const Trajectory& guess,
                  const SolveOptions& options) {
  SolveResult result = solve_once(problem, objectives, guess, options);
  const auto is_solved = [&] {
    return result.status == SolveStatus::optimal || result.status == SolveStatus::acceptable;
  };
  if (!is_solved() || largest_turn(problem, result.trajectory) <= longest_turn) return result;
  // The optimum jumps. Rows against jumps cost time, so they come where they are needed only.
  Problem limited = problem;
  limited.limits.longest_turn = longest_turn;
  result = solve_once(limited, objectives, guess, options);
  if (is_solved() && largest_turn(problem, result.trajectory) > refused_turn) {
    result.status = SolveStatus::failed;
    result.sentence = "bodies turn by more than 2 rad in one step, where the step has no meaning: use a smaller step";
  }
  return result;
}

}  // namespace muldi::control
