#pragma once
/// The state of a run between two steps: everything that a bit-for-bit restart needs.
#include <Eigen/Core>
#include <string>
#include <vector>

#include "variational/factor_use.hpp"

namespace muldi::variational {

/// Where the factors of the substructures were made: with it a restart makes the same ones.
struct FactorPoint {
  bool valid = false;
  bool first = false;  ///< in the first interval of the run
  Eigen::VectorXd q0;  ///< (n_q)
  Eigen::VectorXd q1;  ///< (n_q)
  Eigen::VectorXd y;   ///< (n_y)
};

/// Momentum form: configuration and unprojected momentum at the same node (numerics, 1.5). `y`, `advance` and `factor`
/// are empty in models without substructures.
struct State {
  long step = 0;  ///< nodes passed since t = 0
  double t = 0.0;
  Eigen::VectorXd x;             ///< coordinates of the manifold (n_x)
  Eigen::VectorXd q;             ///< configuration (n_q), rebuilt from x
  Eigen::VectorXd p;             ///< D2 L_d + f+ of the last interval (n_q); M v at t = 0
  Eigen::VectorXd increment;     ///< last minimal increment (n_v), the predictor
  Eigen::VectorXd multipliers;   ///< lambda of the last node (n_loop_rows), of least norm
  Eigen::VectorXd y = {};        ///< stage unknowns of the last interval (n_y), the predictor
  Eigen::VectorXd advance = {};  ///< last increment of the substructures' positions (n_q)
  FactorPoint factor = {};
  FactorUse factor_use = {};
  int exact_steps = 0;  ///< steps to come that solve for substructures with exact derivatives from the start
};

/// How a solver ended; the names are those of the result file (scene format, section 4).
enum class Status {
  running,
  completed,
  interrupted,
  no_convergence,
  loss_of_equilibrium,
  muscle_collapse,
  inverted_element,
  breakdown,
  step_too_large,
  rank_change,
  infeasible,       ///< of optimal control, as the next
  iteration_limit,  ///<
  write_error,
};

std::string name_of(Status status);

}  // namespace muldi::variational
