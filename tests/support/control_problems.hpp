#pragma once
/// Optimal control problems on the systems of support/systems.hpp.
#include <memory>
#include <vector>

#include "control/solve.hpp"
#include "support/systems.hpp"

namespace muldi::test {

/// A model with a problem on it.
struct ControlCase {
  std::unique_ptr<model::Model> model;
  control::Problem problem;

  explicit ControlCase(const RigidSystem& system) : model(make_model(system)), problem{.model = *model} {}
  ControlCase(ControlCase&&) = default;

  void set_horizon(int n_steps, double step) {
    problem.horizon = {.n_steps = n_steps, .shortest_step = step, .longest_step = step};
  }
  /// Seeks all controls of the model, 0 .. upper, by their squares.
  void seek_squares(double upper);
  /// Seeks all controls within +-bound.
  void seek_plain(double bound);
  /// From rest in the scene pose.
  void start_at_rest() { problem.initial.x = model->manifold->reference(); }
  double step() const { return problem.horizon.shortest_step; }
};

/// Reference results B: the muscle joint from rest to rest, 0 -> 7.73 degrees, fields 0 .. 50 kV/mm.
ControlCase joint_case(int n_steps, double step);
/// Reference results B: the trunk from rest to rest with its tip to the printed place; fields 0 .. 40 kV/mm.
ControlCase trunk_case(int n_steps = 40, double step = 25.0);
/// A slider of mass 2 along x with a force on it, control 0; no gravity.
RigidSystem slider(double damping = 0.0);
/// Two coordinates and a ball: a free body with force and torque, tied by a spring to ground.
RigidSystem driven_free_body();

/// sum E^2 in (kV/mm)^2 over all controls.
std::vector<control::WeightedObjective> effort_of_fields(std::size_t n_controls);
std::vector<control::WeightedObjective> feasibility();
double sum_of_squares(const control::Trajectory& trajectory);

/// The largest distance of two trajectories, by minimal increments in natural sizes.
double distance(const model::Model& model, const control::Trajectory& a, const control::Trajectory& b);

}  // namespace muldi::test
