#pragma once
/// The trajectory of an optimum as rows of nodes, as those of a run.
#include "build/built_model.hpp"
#include "control/problem.hpp"
#include "pipeline/node_rows.hpp"
#include "variational/time_loop.hpp"

namespace muldi::pipeline {

/// Momenta, reactions, energies and works at the nodes of a trajectory, by the discrete Legendre transform of its
/// intervals (numerics, 1.5). It need not fulfil the equations of motion: solver/residual says by how much it does not.
class TrajectoryRows {
 public:
  TrajectoryRows(const build::BuiltModel& built, const control::Trajectory& trajectory);

  void write(NodeRows& rows);
  /// Minimal velocities at the first node (n_v).
  const Eigen::VectorXd& initial_rates();

 private:
  /// Momentum and velocities at the first node, and its interval.
  void begin();
  /// Controls of interval n; beyond the end those of the last.
  const std::vector<double>& controls(long n) const;
  /// Forces and work of the interval that begins at the state.
  void evaluate(long n);
  /// -G^T lambda (n_q) and lambda at the node, with half the weight at an end.
  void balance(long n);
  void advance(long n);
  /// Of all intervals: what the residual is relative to, for at rest all terms of a node may be small.
  void find_largest_impulse();
  void record(NodeRows& rows, long n);
  /// Opens the accounts of the electric sources at the first node, and books the change of the controls at node n.
  void book_supply(long n);

  const model::Model& model_;
  const model::Manifold& manifold_;
  const control::Trajectory& trajectory_;
  long n_steps_;
  variational::NodeEvaluator nodes_;
  variational::NodeValues values_;
  variational::State state_;
  variational::Ledger ledger_;
  model::SupplyBook supply_;
  variational::StepReport report_;
  std::unique_ptr<model::Frame> frame_;
  model::IntervalForces forces_;
  model::IntervalWork work_;
  double largest_impulse_ = 0.0;
  Eigen::VectorXd q1_;
  Eigen::VectorXd q_mid_;
  Eigen::VectorXd v_;
  Eigen::VectorXd constraint_force_;
  Eigen::VectorXd multipliers_;
  Eigen::VectorXd projected_;
  Eigen::VectorXd stage_;
};

}  // namespace muldi::pipeline
