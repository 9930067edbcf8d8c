#pragma once
/// Velocities, energies and momenta at a node in time, by the projected Legendre transform (numerics, 1.5 and C15).
#include <memory>
#include <span>

#include "model/model.hpp"
#include "model/substructure_set.hpp"
#include "variational/state.hpp"

namespace muldi::variational {

/// Values at one node; buffers are reused.
struct NodeValues {
  Eigen::VectorXd rate;      ///< minimal velocities w with T^T M T w = T^T p, on the loops B w = 0
  Eigen::VectorXd v;         ///< T w
  Eigen::VectorXd momentum;  ///< M v (n_q), consistent with the constraints
  std::vector<model::Energy> parts;
  model::Energy total;
  double electric_after = 0.0;  ///< electric enthalpy under the controls of the next interval
  Eigen::Vector3d linear_momentum = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();
};

class NodeEvaluator {
 public:
  /// `linear`: solver kind, as StepOptions::linear.
  NodeEvaluator(const model::Model& model, const std::string& linear, const std::string& substructures = "auto");

  /// Velocities, energies and momenta of `state`; `u_before` and `u_after`: controls of the intervals on both sides,
  /// `du`: their rates at the node, for positions that they prescribe (empty: held).
  /// False if the mass matrix is singular on the free motions.
  bool evaluate(const State& state, std::span<const double> u_before, std::span<const double> u_after, NodeValues& out,
                std::span<const double> du = {});
  /// True if positions are prescribed by controls, so that their rates matter.
  bool moves() const { return moves_; }

  /// Multipliers of the loop rows that make the last momentum consistent (n_loop_rows), an impulse of least norm.
  const Eigen::VectorXd& loop_impulse() const { return lambda_; }
  /// The same of the constraints inside substructures (n_y), see Substructure::add_multiplier_impulse.
  const Eigen::VectorXd& stage_impulse() const { return dy_; }

  /// Electric enthalpy alone, for the work of control jumps.
  double electric(const State& state, std::span<const double> u);

  /// M(q) v (n_q).
  void momentum_of(const Eigen::VectorXd& q, const Eigen::VectorXd& v, std::span<const double> u, Eigen::VectorXd& p);

 private:
  /// M v + constraint impulses = p. Constraints inside parts are solved for by passes with exact residuals and a factor
  /// of an earlier node; without such constraints the first pass is exact.
  bool solve_velocities(const State& state, std::span<const double> du, NodeValues& out);
  bool factorise_parts(const State& state, bool anew);
  void residual_of(const State& state, const NodeValues& at);
  /// Adds the solution for the residual; returns its size relative to that of the velocities.
  double improve(NodeValues& out);

  const model::Model& model_;
  std::unique_ptr<model::ProjectedSolver> solver_;
  model::SubstructureSet parts_;
  std::unique_ptr<model::Frame> frame_;
  math::BlockMatrix M_;
  math::BlockMatrix MS_;  // with what eliminated parts leave
  model::IntervalForces forces_;
  Eigen::VectorXd r_;
  Eigen::VectorXd dw_;
  Eigen::VectorXd zero_c_;
  Eigen::VectorXd mu_;
  Eigen::VectorXd lambda_;
  Eigen::VectorXd zero_q_;
  Eigen::VectorXd bracket_;
  Eigen::VectorXd rest_;
  Eigen::VectorXd dv_;
  Eigen::VectorXd dy_;
  Eigen::VectorXd ddy_;
  Eigen::VectorXd h_;
  Eigen::VectorXd factor_q_;  // where the parts were factorised
  bool is_constrained_ = false;
  bool moves_ = false;
  std::vector<model::Energy> scratch_;
};

}  // namespace muldi::variational
