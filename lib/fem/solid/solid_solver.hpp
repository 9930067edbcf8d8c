#pragma once
/// Linearised equations of a solid: an augmented-Lagrangian matrix whose factor serves many iterations.
///
/// With the pressures free and D the compliance of their rows, elimination adds w_e g_e g_e^T, w_e = (c V_e)^2 / D_e,
/// to the matrix of positions and potentials; the incompressible formulations, D = 0, take a finite D_e and repeat. The
/// gradients g_e are those of the factorisation, in every use of the factor (numerics 1.4; a newer one diverges).
#include "fem/solid/solid.hpp"
#include "fem/solid/tied_responses.hpp"
#include "fem/solid/turning.hpp"

namespace muldi::fem {

/// What may be left, relative, of the volumes that the factor of an incompressible solid lets through.
inline constexpr double refined = 1e-14;

class SolidSolver final : public model::SubstructureSolver {
 public:
  SolidSolver(const Solid& solid, model::Linearisation kind);
  /// By the symbolic analysis alone.
  static model::SolverSize size_of(const Solid& solid, model::Linearisation kind);

  bool factorise(const model::IntervalPoint& at) override;
  int unstable_directions() const override;
  void turn(const Eigen::VectorXd& q) override { turning_.turn_to(q); }
  void add_condensed(math::BlockMatrix& K) const override { responses_.add_condensed(K); }
  void reduce(const Eigen::VectorXd& bracket, const Eigen::VectorXd& h) override;
  void add_response(Eigen::VectorXd& bracket) const override { responses_.add_to_bodies(bracket); }
  void expand(Eigen::VectorXd& dq, Eigen::VectorXd& dy) override;
  std::string name() const override;
  std::ptrdiff_t factor_bytes() const { return factor_.size().factor_bytes; }

 private:
  void weigh_pressures(const model::IntervalPoint& at);
  void assemble(const model::IntervalPoint& at);
  /// Displacements, potentials and pressures (total_...) for the rows force_, rows_ and the potentials in rhs_.
  void solve();
  void back_substitute();
  /// Columns of the responses, all at once or each with its volume kept exactly.
  void respond();
  void respond_exactly();
  void refine();
  void add_motion_of_bodies(const Eigen::VectorXd& dq);
  /// The other kinds are iterated with exact residuals.
  bool exact() const { return kind_ == model::Linearisation::rest; }

  const Solid& solid_;
  model::Linearisation kind_;
  bool factorised_ = false;
  math::SymmetricBlockPattern pattern_;
  std::vector<std::int32_t> slots_;
  SolidFactor factor_;
  Turning turning_;
  TiedResponses responses_;
  int expected_negative_ = 0;
  double potential_rows_ = 1.0;  // factor of the rows of the potentials
  double refined_ = refined;     // what may be left of the volumes that a factor lets through
  Volumes lagged_;
  Eigen::VectorXd weight_;      // w_e
  Eigen::VectorXd coupling_;    // c V_e
  Eigen::VectorXd compliance_;  // D_e of the factor
  Eigen::VectorXd curvature_;
  Eigen::VectorXd rhs_;
  Eigen::MatrixXd imposed_;
  Eigen::VectorXd dx_;
  Eigen::VectorXd rows_;
  Eigen::VectorXd dp_;
  Eigen::VectorXd total_x_;
  Eigen::VectorXd total_phi_;
  Eigen::VectorXd total_p_;
  Eigen::VectorXd force_;
};

}  // namespace muldi::fem
