#pragma once
/// Adds the pieces of one interval to the blocks of its two nodes.
///
/// y = (xi, xi', s) with xi = (xi_0 + xi_1)/2, xi' = (xi_1 - xi_0)/h; e_0 = -1, e_1 = 1. The derivative of the force
/// h/2 F + e_i pi on node i by xi_j is B_ij = h/2 (F_xi/2 + e_j/h F_xi') + e_i (pi_xi/2 + e_j/h pi_xi').
#include "control/discrete_dynamics.hpp"

namespace muldi::control {

/// What the pieces of an interval are weighted with.
struct IntervalFrame {
  const PieceList& list;
  const Layout& layout;
  const DynamicsNode& begin;
  const DynamicsNode& end;
  const Eigen::VectorXd& v;
  const std::vector<int>& choice_of_control;
  const std::vector<double>& control_slope;  ///< of every choice: du/dw, or d(u^2)/dw where squared
  double h = 0.0;
  int k = 0;
};

/// Blocks of the Jacobian.
class JacobianSink final : public model::ExpansionSink {
 public:
  JacobianSink(const IntervalFrame& frame, DynamicsJacobian& out) : frame_(frame), out_(out) {}
  void add(const model::LocalForms& forms, const model::LocalExpansion& expansion) override;

 private:
  template <int m, int most>
  void add_piece(const Piece& piece, const model::LocalExpansion& expansion);
  /// What is curved in a coordinate of a loop-closing joint, beside its slopes in add_piece.
  void add_end_piece(const Piece& piece, const model::LocalExpansion& expansion);

  const IntervalFrame& frame_;
  DynamicsJacobian& out_;
  std::size_t at_ = 0;
};

/// Directions that the Hessian is contracted with.
struct AdjointFrame {
  const Eigen::VectorXd& m_begin;  ///< (n_v)
  const Eigen::VectorXd& m_end;
  const Eigen::VectorXd& a;  ///< (a_0 + a_1)/2 (n_q)
  const Eigen::VectorXd& b;  ///< (a_1 - a_0)/h
};

/// Blocks of the Hessian, and the gradients by q_0, q_1 that go through the charts.
class HessianSink final : public model::ExpansionSink {
 public:
  HessianSink(const IntervalFrame& frame, const AdjointFrame& adjoint, DynamicsHessian& out)
      : frame_(frame), adjoint_(adjoint), out_(out) {}
  void add(const model::LocalForms& forms, const model::LocalExpansion& expansion) override;

 private:
  /// A piece's share of the frames.
  template <int m, int most>
  struct Local;
  template <int m, int most>
  Local<m, most> local(const Piece& piece) const;
  template <int m, int most>
  void add_piece(const Piece& piece, const model::LocalExpansion& expansion);
  template <int m, int most>
  void add_controls(const Piece& piece, const model::LocalExpansion& expansion, const Local<m, most>& at);
  template <int m, int most>
  void add_step(const Piece& piece, const model::LocalExpansion& expansion, const Local<m, most>& at);
  /// As that of the Jacobian; `along`: the mean of the coordinate's slopes along the adjoints.
  void add_end_piece(const Piece& piece, const model::LocalExpansion& expansion, double along);

  const IntervalFrame& frame_;
  const AdjointFrame& adjoint_;
  DynamicsHessian& out_;
  std::size_t at_ = 0;
};

}  // namespace muldi::control
