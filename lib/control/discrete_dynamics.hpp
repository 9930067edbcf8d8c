#pragma once
/// The discrete equations of motion over a horizon, in the coordinates theta_n of every node, with exact first and
/// second derivatives (numerics, 1.11).
///
/// With D = dq/dtheta, F = dL/dq + f, pi = dL/dv and the joint forces Q over the intervals, the balance of node n is
///
///     r_n = D_n^T [ (h/2 F + pi)_{n-1/2} + (h/2 F - pi)_{n+1/2} - G(q_n)^T Z_n mu_n ] + h/2 (Q_{n-1/2} + Q_{n+1/2}):
///
/// (with forces on loop-closing joints h/2 Q g(q_n), g the gradient of the joint's coordinate, in the bracket too)
/// the derivative of the discrete action by theta_n. At the ends the half that does not exist is left out; the end
/// momenta are added by the transcription. Closed loops add the rows Z_n^T g(q_n).
///
/// The Hessian of sum_n m_n . r_n: with a_n = D_n m_n an interval contributes the scalar Phi = h [(a_0 + a_1)/2 . F +
/// (a_1 - a_0)/h . pi] + h/2 (m_0 + m_1) . Q of (q_0, a_0, q_1, a_1, u, h), linear in a; then the chain rule with q and
/// a as functions of theta. All of it is tridiagonal in the nodes.
#include <memory>
#include <vector>

#include "control/layout.hpp"
#include "control/pieces.hpp"
#include "control/problem.hpp"

namespace muldi::control {

using Matrices = std::vector<Eigen::MatrixXd>;
using Vectors = std::vector<Eigen::VectorXd>;

/// One node in time at the current iterate.
struct DynamicsNode {
  std::unique_ptr<model::Chart> chart;
  Eigen::VectorXd theta;
  Eigen::VectorXd x;
  model::ChartPoint point;
  Eigen::VectorXd lambda;   ///< Z mu (n_loop_rows)
  Eigen::MatrixXd Z;        ///< basis of the loop rows (n_loop_rows, n_c)
  Eigen::VectorXd bracket;  ///< what D^T projects (n_q)
  Eigen::MatrixXd MD;       ///< M D, then M A beside it (n_q, n_v)
  Eigen::MatrixXd MA;
  Matrices J;  ///< of every piece (m, columns)
  Matrices A;
};

/// One interval at the current iterate.
struct DynamicsInterval {
  Eigen::VectorXd q;
  Eigen::VectorXd v;
  std::vector<double> u;  ///< all controls
  model::IntervalForces forces;
};

/// First derivatives of the balances. Row node n, column node n - 1, n, n + 1; controls of the intervals that end and
/// begin at n; the step.
struct DynamicsJacobian {
  Matrices previous;  ///< [n]: by theta_{n-1}
  Matrices diagonal;
  Matrices next;
  Matrices by_w_before;  ///< [n]: by w_{n-1} (n_v, n_u)
  Matrices by_w_after;
  Vectors by_step;
  Matrices by_lambda;  ///< (n_v, n_c)
  Matrices closing;    ///< d(Z^T g)/dtheta (n_c, n_v)

  void resize(const Layout& layout);
  void set_zero();
};

/// Second derivatives of sum m . r + sum nu . (Z^T g), with what is still to be taken through the chart.
struct DynamicsHessian {
  Matrices diagonal;
  Matrices below;    ///< [n]: (theta_{n+1}, theta_n)
  Matrices w_begin;  ///< [k]: (w_k, theta_k)
  Matrices w_end;    ///< [k]: (w_k, theta_{k+1})
  Matrices ww;
  Matrices lambda;  ///< [n]: (mu_n, theta_n)
  Vectors step_theta;
  Vectors step_w;
  double step_step = 0.0;
  Vectors y;  ///< [n]: gradient by q_n, of what is frozen in the chart (n_q)

  void resize(const Layout& layout, Eigen::Index n_q);
  void set_zero();
};

class DiscreteDynamics {
 public:
  /// `guess`: references of balls, bases of the loops. The problem must outlive this.
  DiscreteDynamics(const Problem& problem, const Layout& layout, const Trajectory& guess);

  const PieceList& pieces() const { return pieces_; }
  std::span<const double> squared() const { return squared_; }
  const std::vector<int>& choice_of_control() const { return choice_of_control_; }
  DynamicsNode& node(int n) { return nodes_[static_cast<std::size_t>(n)]; }
  const DynamicsNode& node(int n) const { return nodes_[static_cast<std::size_t>(n)]; }
  const DynamicsInterval& interval(int k) const { return intervals_[static_cast<std::size_t>(k)]; }
  double step() const { return h_; }

  /// Evaluates configurations and forces at unscaled unknowns; false where a term cannot be evaluated.
  bool move_to(const Eigen::VectorXd& unknowns);
  /// u of a choice from its unknown w.
  double control_value(int choice, double w) const;
  double control_unknown(int choice, double u) const;

  /// r_n (n_v) without end momenta.
  void balance(int n, Eigen::VectorXd& out) const;
  /// Z_n^T g(q_n) (n_c).
  void closing(int n, Eigen::VectorXd& out) const;
  void jacobian(DynamicsJacobian& out);
  /// `m`: [n] (n_v), zero where there is no balance; `nu`: [n] (n_c) of the closing rows. Evaluates the charts along m.
  /// The caller may add to `out` and then takes y through the charts by finish().
  void hessian(const Vectors& m, const Vectors& nu, DynamicsHessian& out);
  void finish(DynamicsHessian& out);

 private:
  void update_pieces(DynamicsNode& node, bool along) const;
  model::IntervalPoint point_of(int k) const;
  void add_constant_blocks(int k, DynamicsJacobian& out) const;
  void add_constant_blocks(int k, DynamicsHessian& out);
  void add_loop_blocks(int n, DynamicsJacobian& out) const;
  void add_loop_blocks(int n, const Eigen::VectorXd& nu, DynamicsHessian& out) const;

  const Problem& problem_;
  const model::Model& model_;
  Layout layout_;
  PieceList pieces_;
  std::vector<double> squared_;
  std::vector<int> choice_of_control_;  // of the model; -1 where it is not sought
  std::vector<DynamicsNode> nodes_;
  std::vector<DynamicsInterval> intervals_;
  double h_ = 0.0;
  bool has_pieces_ = false;  // J and MD of the nodes belong to the iterate
  Eigen::VectorXd a_mid_;
  Eigen::VectorXd a_rate_;
  Eigen::VectorXd M_rate_;
};

}  // namespace muldi::control
