#pragma once
/// Static equilibrium on the constraint manifold: Newton with regularisation, line search and a stability check.
///
///     T(q)^T [ F(q, u) - G_c(q)^T lambda ] + Q(x, u) = 0,  g_c(q) = 0,  F = dL/dq + f at rest,
/// with the tangent T^T (-F_q) T - Q_x and the curvature of the manifold (numerics, 4.5), which forces Q on the minimal
/// rates do not see. Substructures are eliminated: they
/// leave forces and a stiffness on the bodies, and their own stability is read off the signs of their pivots.
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "model/substructure_set.hpp"

namespace muldi::statics {

struct EquilibriumOptions {
  double tolerance = 1e-10;  ///< largest dimensionless Newton increment whose result is accepted
  int max_iterations = 50;
  std::string substructures = "auto";  ///< solver of the substructures, as their make_solver takes it
};

/// A configuration at rest with the multipliers of the loops.
struct StaticState {
  Eigen::VectorXd x;            ///< (n_x)
  Eigen::VectorXd multipliers;  ///< (n_loop_rows), of least norm
  Eigen::VectorXd q = {};       ///< (n_q), of which the slices of substructures count; empty without substructures
  Eigen::VectorXd y = {};       ///< stage unknowns (n_y)
};

/// A motion of all unknowns at rest.
struct StaticMotion {
  Eigen::VectorXd w;            ///< minimal increments (n_v)
  Eigen::VectorXd multipliers;  ///< (n_loop_rows)
  Eigen::VectorXd q = {};       ///< slices of substructures (n_q); empty without them
  Eigen::VectorXd y = {};       ///< (n_y)
};

enum class Stability {
  stable,    ///< the projected tangent is positive definite on the admissible motions
  unstable,  ///< it has a negative direction
  free,      ///< it has a direction without stiffness: the system can move without any force
};

struct EquilibriumReport {
  bool converged = false;
  Stability stability = Stability::stable;
  int iterations = 0;
  double residual = 0.0;     ///< relative
  std::string inadmissible;  ///< why the terms could not be evaluated, or what limits: collapsed muscle, inverted cell
};

class EquilibriumSolver {
 public:
  EquilibriumSolver(const model::Model& model, EquilibriumOptions options);

  /// Moves `state` to an equilibrium under the controls u; unchanged if it does not converge.
  EquilibriumReport solve(StaticState& state, std::span<const double> u);

  /// Evaluates residual, constraints and tangent at a state.
  void linearise(const StaticState& state, std::span<const double> u);
  const Eigen::VectorXd& residual() const { return r_; }   ///< T^T (F - G^T lambda) (n_v)
  const Eigen::VectorXd& gaps() const { return g_; }       ///< Z^T g (n_c), Z chosen at the linearised state
  const Eigen::MatrixXd& tangent() const { return A_; }    ///< (n_v, n_v)
  const Eigen::MatrixXd& loop_rows() const { return B_; }  ///< Z^T G T (n_c, n_v)
  const Eigen::MatrixXd& loop_basis() const { return manifold_.loop_basis(*frame_); }  ///< Z (n_loop_rows, n_c)
  const Eigen::VectorXd& configuration() const { return q_; }                          ///< (n_q)
  const Eigen::VectorXd& stage() const { return y_; }                                  ///< (n_y)
  /// F (n_q), with the forces on the minimal rates.
  const Eigen::VectorXd& force() const { return force_; }
  const Eigen::VectorXd& scale() const { return scale_; }  ///< natural size of increments (n_v)
  /// True if the terms could be evaluated and the substructures factorised at the linearised state.
  bool is_regular() const { return !singular_ && forces_.margin > 0.0; }
  /// T^T sum_c dF/du_c du_c (n_v) at the linearised state, the response of eliminated substructures included.
  Eigen::VectorXd load_rate(std::span<const double> u, std::span<const double> du);
  /// Once after linearise(): the plain Newton step, and the motion of the equilibrium when the controls move along
  /// `du`.
  void motions(std::span<const double> u, std::span<const double> du, StaticMotion& newton, StaticMotion& load);
  /// Product of two motions in natural sizes: of rates, and the mean over the nodes of the substructures.
  double product(const StaticMotion& a, const StaticMotion& b) const;
  /// Largest entry of a motion in natural sizes; those of the stage unknowns and of prescribed ones count.
  double size_of(const StaticMotion& motion) const;
  void move(const StaticState& start, double factor, const StaticMotion& along, StaticState& trial) const;
  /// The same for predictions, which may be long: tied substructures swing with their bodies, however far these turn.
  void swing(const StaticState& start, double factor, const StaticMotion& along, StaticState& trial);
  /// b - a, of rates and substructures.
  StaticMotion difference(const StaticState& a, const StaticState& b) const;
  /// Gives a linearised equilibrium the values that are prescribed, and multipliers of least norm.
  void settle(StaticState& state);
  /// Why the terms cannot be evaluated at a state, or empty; the second looks into substructures and uses the placed
  /// values of the linearised state.
  std::string why_inadmissible(const StaticState& state);
  std::string why_inadmissible_anywhere() const { return model_.inadmissible_anywhere(q_); }
  /// Residual over its largest term, at the linearised state.
  double relative_residual() const { return residual_; }
  Stability stability() const;
  /// For models with substructures, after linearise() at an equilibrium: moves `state` along the tangent to the
  /// controls u; returns the largest increment of the substructures, less their swing with the bodies.
  double predict(StaticState& state, std::span<const double> u);
  /// Largest difference of the substructures' unknowns of two states, in natural sizes; 0 without substructures.
  double distance(const StaticState& a, const StaticState& b);

 private:
  model::IntervalPoint point(const StaticState& state, std::span<const double> u) const;
  void evaluate(const StaticState& state, std::span<const double> u);
  /// r_ from bracket_ and the forces on the minimal rates.
  void project_bracket();
  void newton_increment();
  /// True if nothing has been evaluated, and no configuration written, since linearise() was there, so that factors and
  /// answers of the parts stand.
  bool is_linearised_at(const StaticState& state, std::span<const double> u) const;
  /// Relative to the longest that is taken whole, without its stage unknowns, in which the equations are nearly linear.
  double length_of(const StaticMotion& motion) const;
  void scale_increment(double factor);
  void measure_residual();
  EquilibriumReport iterate(StaticState& state, std::span<const double> u);
  /// After a failure without a reason: what becomes inadmissible further along the last increment; changes q_.
  std::string limit_of_increment();
  double line_search(const StaticState& start, StaticState& trial, std::span<const double> u,
                     std::string& inadmissible);

  const model::Model& model_;
  const model::Manifold& manifold_;
  EquilibriumOptions options_;
  model::SubstructureSet parts_;
  std::unique_ptr<model::Frame> frame_;
  math::BlockMatrix K_;
  model::IntervalForces forces_;
  Eigen::VectorXd q_;
  Eigen::VectorXd before_;  // of a motion of finite size
  Eigen::VectorXd excess_;
  Eigen::VectorXd zero_;
  Eigen::VectorXd force_;
  Eigen::VectorXd bracket_;
  Eigen::VectorXd total_;  // the bracket before parts are eliminated: all forces on the bodies
  Eigen::VectorXd r_;
  Eigen::VectorXd diagonal_;  // derivatives of the forces on the minimal rates
  Eigen::VectorXd gaps_;      // of all loop rows
  Eigen::VectorXd g_;         // Z^T gaps
  Eigen::VectorXd scale_;
  Eigen::MatrixXd A_;
  Eigen::MatrixXd B_;
  Eigen::VectorXd y_;
  StaticMotion step_;
  struct {
    StaticState state = {};
    std::vector<double> u = {};  ///< empty: nowhere
  } linearised_;
  double terms_ = 0.0;
  double residual_ = 0.0;
  std::string shortened_by_;  // why a step was not taken whole, the last time
  bool singular_ = false;     // the matrix of a substructure
};

}  // namespace muldi::statics
