#pragma once
/// The contract of solvers of nonlinear programs; each is a module that is opened by the first problem that needs it.
#include <string>

#include "control/nlp.hpp"
#include "control/solve.hpp"

namespace muldi::control {

/// What a solver returns.
struct NlpResult {
  SolveStatus status = SolveStatus::failed;
  std::string sentence = {};  ///< what the solver says, in our words
  Eigen::VectorXd x = {};     ///< the solution, or the best iterate
  int iterations = 0;
  int derivative_errors = -1;       ///< of its own check; -1 without
  std::string derivative_log = {};  ///< what the check found
  double function_time = 0.0;       ///< s in values and first derivatives
  double hessian_time = 0.0;        ///< s in second derivatives
};

/// Minimises from `start`.
using NlpSolver = NlpResult (*)(Nlp& nlp, const Eigen::VectorXd& start, const SolveOptions& options);

/// The solver, opened on demand; null, with the reason, where it cannot be.
NlpSolver open_nlp_solver(std::string& why_not);

}  // namespace muldi::control
