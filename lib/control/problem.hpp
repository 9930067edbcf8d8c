#pragma once
/// An optimal control problem as plain data: no solver, no scene (numerics, 1.11).
#include <string>
#include <vector>

#include "control/conditions.hpp"
#include "control/registry.hpp"
#include "model/model.hpp"

namespace muldi::control {

/// The quantity that the optimiser varies in place of a control u.
enum class ControlKind {
  plain,    ///< u itself
  squared,  ///< w = (u/reference)^2 >= 0: the dynamics are affine in it where u is a field (numerics, C11)
};

/// A control of the model that is sought.
struct ControlChoice {
  int control = 0;  ///< index in the model's controls
  ControlKind kind = ControlKind::plain;
  double lower = -infinity;  ///< of u; not below 0 where squared
  double upper = infinity;
  double reference = 1.0;  ///< u where w = 1: the upper bound, or a natural value
};

/// Length of the horizon: fixed where both are equal.
struct Horizon {
  int n_steps = 0;
  double shortest_step = 0.0;
  double longest_step = 0.0;

  bool is_free() const { return shortest_step < longest_step; }
};

struct Problem {
  const model::Model& model;
  Horizon horizon = {};
  std::vector<ControlChoice> controls =
      {};  ///< each control of the model at most once; the others follow their functions
  EndCondition initial = {};
  EndCondition final = {};
  PathLimits limits = {};
};

/// A trajectory: guess and result.
struct Trajectory {
  double step = 0.0;
  std::vector<Eigen::VectorXd> x = {};      ///< (n_steps + 1) coordinates of the manifold (n_x)
  std::vector<std::vector<double>> u = {};  ///< (n_steps) all controls of the model, in their own units
  /// Multipliers lambda of the loop rows at the nodes 0 .. n_steps (n_loop_rows), forces as those of the stepper; empty
  /// where unknown.
  std::vector<Eigen::VectorXd> multipliers = {};
};

/// What is minimised: the weighted sum.
struct WeightedObjective {
  double weight = 1.0;
  Objective objective = {};
};

/// Something that rules a problem out before it is solved.
struct Fault {
  std::string where;  ///< key below optimal_control, e.g. "final.points" or "controls.agonist"
  std::string why;
};

/// The kind that suits a control of the model: squared where the forces in the scene pose are affine in u^2.
ControlKind kind_of_control(const model::Model& model, int control);

/// Everything that can be known before the solve: terms without second adjoint derivatives, empty horizons, crossed
/// bounds, unreachable or contradictory end conditions, more conditions than freedoms.
std::vector<Fault> find_faults(const Problem& problem, const Trajectory& guess);

}  // namespace muldi::control
