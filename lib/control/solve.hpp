#pragma once
/// Solves an optimal control problem: transcription, solver, report.
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "control/problem.hpp"

namespace muldi::control {

/// How a solve ended.
enum class SolveStatus {
  optimal,     ///< to the tolerance
  acceptable,  ///< to a looser tolerance, no further progress
  infeasible,  ///< no motion near the guess fulfils the conditions
  iteration_limit,
  interrupted,  ///< by the user; the best iterate is kept
  failed,       ///< the solver gave up: see the sentence
  unavailable,  ///< no solver library
};
std::string name_of(SolveStatus status);

/// One row of the iterates table.
struct Iterate {
  int iteration = 0;
  bool restoration = false;  ///< the solver works on the infeasibility alone
  double objective = 0.0;
  double infeasibility = 0.0;       ///< largest scaled violation of a constraint
  double dual_infeasibility = 0.0;  ///< of the scaled optimality conditions
  double barrier = 0.0;
  double step_size = 0.0;  ///< of the largest component
  double primal_step = 0.0;
  double dual_step = 0.0;
  double regularisation = 0.0;
};

struct SolveOptions {
  int max_iterations = 1000;
  double tolerance = 1e-8;
  std::function<void(const Iterate&)> progress = {};
  std::function<bool()> interrupted = {};
  bool check_derivatives = false;    ///< by the solver's own differences at the start; counts go to SolveResult
  bool approximate_hessian = false;  ///< updated from gradients (limited memory) in place of the exact one; benchmarks
};

/// A bound or limit that holds with equality at the solution.
struct ActiveBound {
  std::string name;  ///< e.g. "agonist" or "limits.joints.hinge"
  bool upper = false;
  std::vector<int> nodes;  ///< intervals of controls, nodes of the rest
};

/// Where the time went (s).
struct SolveTimes {
  double transcription = 0.0;  ///< structure, conditions, scaling
  double functions = 0.0;      ///< values and first derivatives
  double hessian = 0.0;
  double total = 0.0;
};

struct SolveResult {
  SolveStatus status = SolveStatus::failed;
  std::string sentence;    ///< what happened, for the user
  Trajectory trajectory;   ///< the best that was found
  double objective = 0.0;  ///< unscaled
  double infeasibility = 0.0;
  int iterations = 0;
  int n_variables = 0;
  int n_constraints = 0;
  int derivative_errors = -1;       ///< of the solver's own check; -1 without
  std::string derivative_log = {};  ///< what it found
  std::string worst_constraint;     ///< name
  double worst_time = 0.0;          ///< its time
  double worst_violation = 0.0;
  std::vector<ActiveBound> active;
  SolveTimes times;
};

/// Solves from a guess. The guess' step may lie outside the bounds: it is moved into them.
SolveResult solve(const Problem& problem, std::span<const WeightedObjective> objectives, const Trajectory& guess,
                  const SolveOptions& options);

/// One line of `check --derivatives`.
struct DerivativeCheck {
  std::string what;       ///< e.g. "constraints: Jacobian"
  double slope = 0.0;     ///< of the Taylor remainder, infinite where it is round-off
  double expected = 0.0;  ///< 2 for first, 3 for second derivatives
  double error = 0.0;     ///< relative, against differences
  bool passed = false;
};
/// Taylor tests of the transcribed problem near the guess, in a direction that touches all unknowns.
std::vector<DerivativeCheck> check_derivatives(const Problem& problem, std::span<const WeightedObjective> objectives,
                                               const Trajectory& guess);

/// The same of every term of a model that has adjoint derivatives, near the scene pose.
std::vector<DerivativeCheck> check_terms(const model::Model& model);

/// The trajectory of the forward integrator under given controls: a guess that fulfils the dynamics until
/// the integrator stops; afterwards the last pose is held. `u`: (n_steps) all controls.
Trajectory simulate_guess(const Problem& problem, double step, const std::vector<std::vector<double>>& u);
/// The initial pose, held, under the lowest controls (0 where there is no bound).
Trajectory resting_guess(const Problem& problem, double step);
/// A guess of another step or number of steps, from a trajectory by interpolation.
Trajectory refined_guess(const Problem& problem, const Trajectory& coarse);

}  // namespace muldi::control
