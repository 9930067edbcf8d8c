#pragma once
/// Linearised equations of a solid: an augmented-Lagrangian matrix whose factor serves many iterations.
///
/// With the pressures free and D the compliance of their rows, elimination adds w_e g_e g_e^T, w_e = (c V_e)^2 / D_e,
/// to the matrix of positions and potentials; the incompressible formulations, D = 0, take a finite D_e and repeat. The
/// gradients g_e are those of the factorisation, in every use of the factor (numerics 1.4; a newer one diverges).
#include "fem/solid/exact_responses.hpp"
#include "fem/solid/solid_action.hpp"
#include "fem/solid/solver_choice.hpp"
#include "fem/solid/tied_responses.hpp"
#include "fem/solid/turning.hpp"
#include "math/krylov.hpp"

namespace muldi::fem {

/// What may be left, relative, of the volumes that the factor of an incompressible solid lets through.
inline constexpr double refined = 1e-15;
inline constexpr int max_refinements = 60;
/// Part of the factor's compliance that is left in the volume rows of an increment; it vanishes with the increment.
inline constexpr double proximal = 1e-9;

class SolidSolver final : public model::SubstructureSolver {
 public:
  /// `name` as make_linear takes it.
  SolidSolver(const Solid& solid, model::Linearisation kind, const std::string& name);
  /// By the symbolic analysis alone.
  static model::SolverSize size_of(const Solid& solid, model::Linearisation kind, const std::string& name);
  /// InputError for a solver that cannot serve the solid.
  static void check(const Solid& solid, const std::string& name);

  bool factorise(const model::IntervalPoint& at) override;
  void linearise(const model::IntervalPoint& at, double accuracy) override;
  int unstable_directions() const override;
  void turn(const Eigen::VectorXd& q) override { turning_.turn_to(q); }
  void reduce(const Eigen::VectorXd& bracket, const Eigen::VectorXd& h) override;
  void add_response(Eigen::VectorXd& bracket) const override { responses_.add_to_bodies(bracket); }
  void add_condensed(math::BlockMatrix& K) const override { responses_.add_condensed(K); }
  void expand(Eigen::VectorXd& dq, Eigen::VectorXd& dy) override;
  std::string name() const override;

 private:
  /// Takes a factor in place of the iteration if steps of this length are stiff, by the matrix of the reference, so
  /// that a restart decides alike.
  void decide(const model::IntervalPoint& at);
  void weigh_pressures(const model::IntervalPoint& at);
  void assemble(const model::IntervalPoint& at);
  void back_substitute();
  /// In the frame of the factor, as residual_ and total_ are.
  void solve_lagged(const SolidVector& rows, SolidVector& out);
  /// rhs_ from the rows of positions and potentials.
  void pack_rows(const SolidVector& rows);
  /// Columns of the responses, all at once or each with its volume kept exactly.
  void make_responses();
  bool keep_volumes_exactly();
  void make_exact_responses();
  void add_motion_of_bodies(const Eigen::VectorXd& dq);
  void solve_exactly();
  void turn_forth(Eigen::VectorXd& x) const;
  void pack(const SolidVector& from, Eigen::VectorXd& to) const;
  void unpack(const Eigen::VectorXd& from, SolidVector& to) const;
  void refine(SolidVector& out);
  void respond(const Eigen::VectorXd& p);
  double volt() const { return solid_.potential_scale() > 0.0 ? solid_.potential_scale() : 1.0; }
  /// The other kinds are iterated with exact residuals.
  bool exact() const { return kind_ == model::Linearisation::rest; }

  const Solid& solid_;
  model::Linearisation kind_;
  bool factorised_ = false;
  bool open_ = false;  ///< the first matrix decides on the solver
  math::SymmetricBlockPattern pattern_;
  std::vector<std::int32_t> slots_;
  BondFold fold_;
  int expected_negative_ = 0;
  std::unique_ptr<SolidLinear> linear_;
  Turning turning_;
  TiedResponses responses_;
  double potential_rows_ = 1.0;  // factor of the rows of the potentials
  double refined_ = refined;     // what may be left of the volumes that a factor lets through
  Volumes lagged_;
  Eigen::VectorXd weight_;      // w_e
  Eigen::VectorXd coupling_;    // c V_e
  Eigen::VectorXd compliance_;  // D_e of the factor
  Eigen::VectorXd curvature_;
  Eigen::VectorXd rhs_;
  Eigen::MatrixXd imposed_;
  ExactResponses exact_responses_;
  Eigen::VectorXd dx_;
  Eigen::VectorXd rows_;
  Eigen::VectorXd dp_;
  SolidVector residual_;
  SolidVector total_;
  Eigen::VectorXd force_;
  Eigen::VectorXd scaled_p_;
  math::ConjugateGradients complement_cg_;
  math::Minres complement_minres_;
  double accuracy_ = 0.0;  // of increments with the exact derivative; 0: none
  SolidAction action_;
  math::FlexibleGmres gmres_;
  SolidVector direction_, product_, response_;
  Eigen::VectorXd start_, increment_;
};

}  // namespace muldi::fem
