#pragma once
/// The explicit variant of the integrator (thesis 4.3.2, numerics 1.4), for substructures alone.
///
///     M v = p_n + dt/2 F(r_n, phi_n),   r_{n+1} = r_n + dt v,   R_phi(r_{n+1}, phi_{n+1}) = 0,
///     p_{n+1} = M v + dt/2 F(r_{n+1}, phi_{n+1}),
/// the trapezoidal rule for the action: at the inner nodes the equations of alpha = 0, M (r_{n+1} - 2 r_n + r_{n-1}) =
/// dt^2 F(r_n), but with momenta and a first step of second order. M is the consistent mass, factorised once; the
/// controls of an interval hold at both its ends, so that where they change the potentials are solved twice at a node.
/// Stable for dt < 2/omega_max.
#include <span>
#include <vector>

#include "model/substructure_set.hpp"
#include "variational/step_method.hpp"

namespace muldi::variational {

class ExplicitStepper final : public StepMethod {
 public:
  /// For models of substructures that have no pressures, dampers or ties to bodies. The model must outlive it.
  ExplicitStepper(const model::Model& model, double dt);

  /// Before the first step, and every thousand steps after, refuses a step beyond the stable one
  /// (Status::step_too_large). Allocates nothing in between.
  StepReport advance(State& state, std::span<const double> u) override;
  const Eigen::VectorXd& constraint_force() const override { return constraint_force_; }

  /// 2/omega_max at a configuration and its potentials, by Lanczos' method for M^-1 K with the potentials condensed; an
  /// eigenvalue lies within its error bound, which is added.
  double stable_step(const State& state, std::span<const double> u);

 private:
  void settle(const Eigen::VectorXd& q, std::span<const double> u, Eigen::VectorXd& y);
  /// Forces at q and momenta of v_.
  void evaluate(const Eigen::VectorXd& q, std::span<const double> u, const Eigen::VectorXd& y);
  /// dv = M^-1 rows on what is free.
  void solve_mass(Eigen::VectorXd& rows, Eigen::VectorXd& dv);
  /// Forces (n_q), free rows, at q with potentials in equilibrium there.
  void settled_forces(const Eigen::VectorXd& q, std::span<const double> u, Eigen::VectorXd& rows);
  /// out = -dF/dq along a direction, the potentials following: by differences.
  void stiffness_along(const State& state, std::span<const double> u, const Eigen::VectorXd& along,
                       Eigen::VectorXd& out);
  void mass_along(const State& state, std::span<const double> u, const Eigen::VectorXd& along, Eigen::VectorXd& out);

  const model::Model& model_;
  double dt_;
  model::SubstructureSet mass_;
  math::BlockMatrix unused_;
  model::IntervalForces forces_;
  Eigen::VectorXd q_;
  Eigen::VectorXd q_mid_;
  Eigen::VectorXd v_;
  Eigen::VectorXd dv_;
  Eigen::VectorXd y_;
  Eigen::VectorXd dy_;
  Eigen::VectorXd zero_y_;
  Eigen::VectorXd force_;
  Eigen::VectorXd bracket_;
  Eigen::VectorXd constraint_force_;
  std::vector<double> u_last_;
  std::vector<double> u_end_;
  bool checked_ = false;
};

}  // namespace muldi::variational
