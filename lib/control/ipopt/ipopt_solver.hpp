#pragma once
/// Ipopt as a solver of nonlinear programs: the module libmuldi_ipopt.so.
#include "control/nlp_solver.hpp"

namespace muldi::control {

NlpResult solve_with_ipopt(Nlp& nlp, const Eigen::VectorXd& start, const SolveOptions& options);

}  // namespace muldi::control

/// The symbol that open_nlp_solver() looks for.
extern "C" const muldi::control::NlpSolver muldi_solve_nlp;
