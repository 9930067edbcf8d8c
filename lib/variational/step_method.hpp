#pragma once
/// What the time loop asks of an integrator.
#include <span>

#include "model/model.hpp"
#include "variational/state.hpp"

namespace muldi::variational {

/// What one step reports.
struct StepReport {
  Status status = Status::running;
  std::string sentence;  ///< why it failed
  int iterations = 0;
  int factorisations = 0;
  double residual = 0.0;  ///< largest projected residual relative to the largest term of it
  model::IntervalWork work;
  double rotation = 0.0;         ///< largest turn of a body in the step (rad)
  int turning = -1;              ///< node of the model that is this body; none: nothing turns
  double loop_regularity = 1.0;  ///< relative to that at the start; 0 where the step passed a change of rank
  double violation = 0.0;        ///< of the constraints inside substructures at the end, dimensionless
};

class StepMethod {
 public:
  virtual ~StepMethod() = default;

  /// Moves `state` one step on with the controls `u` at the middle of the interval; on failure `state` is unchanged.
  virtual StepReport advance(State& state, std::span<const double> u) = 0;
  /// -G^T lambda (n_q) at the node that the last step left, all constraints; the momentum form gives it as the part of
  /// the equation of motion that the free motions do not see.
  virtual const Eigen::VectorXd& constraint_force() const = 0;
};

}  // namespace muldi::variational
