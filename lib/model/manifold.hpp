#pragma once
/// The contract of constraints: the set of admissible configurations, its null-space matrix, and projected linear
/// systems.
///
/// Configurations are rebuilt from coordinates x (joint angles, slides, unit quaternions, free lengths), so the
/// constraints of a tree hold to round-off in every state (numerics, 1.8 ii). Loop-closing joints keep independent
/// constraint rows g(q) = 0 with multipliers (numerics, 1.9). T(q) is the null-space matrix: every admissible velocity
/// is T(q) w with minimal velocities w. T is the identity on unknowns without constraints.
#include <Eigen/Core>
#include <memory>
#include <string>

#include "math/block_matrix.hpp"

namespace muldi::model {

/// T(q) at one configuration, in whatever factored form the manifold likes.
class Frame {
 public:
  virtual ~Frame() = default;
};

/// Factorised projected system of one Newton iteration,
///     [ T_l^T K T_r   B_l^T ] [ w      ]   [ r  ]
///     [ B_r           0     ] [ lambda ] = [ g  ],   B = G T of the loop-closing rows.
class ProjectedSolver {
 public:
  virtual ~ProjectedSolver() = default;
  /// False if the system is singular to working precision. Allocates nothing after the first call.
  virtual bool factorise(const Frame& left, const Frame& right, const math::BlockMatrix& K) = 0;
  /// r (n_v), g (n_c) in; w (n_v), lambda (n_c) out.
  virtual void solve(const Eigen::VectorXd& r, const Eigen::VectorXd& g, Eigen::VectorXd& w,
                     Eigen::VectorXd& lambda) = 0;
  virtual std::string name() const = 0;
};

class Manifold {
 public:
  virtual ~Manifold() = default;

  virtual int n_x() const = 0;  ///< stored coordinates
  virtual int n_q() const = 0;  ///< redundant configuration
  virtual int n_v() const = 0;  ///< minimal velocities
  virtual int n_c() const = 0;  ///< independent rows of the loop-closing joints

  /// Natural size of each minimal increment (n_v): 1 for angles, the size of the scene for lengths.
  virtual Eigen::VectorXd rate_scale() const = 0;

  /// Coordinates of the scene pose (n_x).
  virtual Eigen::VectorXd reference() const = 0;
  /// q from x.
  virtual void configuration(const Eigen::VectorXd& x, Eigen::VectorXd& q) const = 0;
  /// x_new = x moved along the minimal increment w; `x_new` may be `x`.
  virtual void retract(const Eigen::VectorXd& x, const Eigen::VectorXd& w, Eigen::VectorXd& x_new) const = 0;
  /// The increment w with x_to = retract(x_from, w); predictors and differences use it.
  virtual void difference(const Eigen::VectorXd& x_from, const Eigen::VectorXd& x_to, Eigen::VectorXd& w) const = 0;

  virtual std::unique_ptr<Frame> make_frame() const = 0;
  virtual void update(const Eigen::VectorXd& x, const Eigen::VectorXd& q, Frame& frame) const = 0;
  /// r = T^T f; f (n_q), r (n_v).
  virtual void project(const Frame& frame, const Eigen::VectorXd& f, Eigen::VectorXd& r) const = 0;
  /// dq = T w.
  virtual void lift(const Frame& frame, const Eigen::VectorXd& w, Eigen::VectorXd& dq) const = 0;

  /// g (n_c): violation of the loop-closing rows.
  virtual void constraints(const Eigen::VectorXd& q, Eigen::VectorXd& g) const = 0;
  /// f += factor G(q)^T lambda.
  virtual void add_constraint_forces(const Eigen::VectorXd& q, double factor, const Eigen::VectorXd& lambda,
                                     Eigen::VectorXd& f) const = 0;
  /// Largest violation of all constraints, those of the tree and redundant loop rows included; gaps are divided by the
  /// size of the scene.
  virtual double violation(const Eigen::VectorXd& q) const = 0;

  /// A = T^T K T as a dense matrix (n_v, n_v), and B = G T (n_c, n_v).
  virtual void project_tangent(const Frame& left, const Frame& right, const math::BlockMatrix& K,
                               Eigen::MatrixXd& A) const = 0;
  virtual void project_constraints(const Frame& frame, Eigen::MatrixXd& B) const = 0;
  /// A -= d(T(q)^T f)/dw + sum_i lambda_i T^T (-d2g_i/dq2) T for frozen f and lambda: the curvature of the manifold,
  /// which statics and modes need (numerics, 4.5). `f` is the total force including constraint forces.
  virtual void add_curvature(const Frame& frame, const Eigen::VectorXd& f, const Eigen::VectorXd& lambda,
                             Eigen::MatrixXd& A) const = 0;

  /// `kind`: auto | tree | dense | bordered. InputError when the wanted kind cannot solve this system.
  virtual std::unique_ptr<ProjectedSolver> make_solver(const math::BlockPattern& pattern,
                                                       const std::string& kind) const = 0;

  /// Smallest over largest pivot of the independent loop rows at this frame (1 without loops): 0 means a change of
  /// rank.
  virtual double loop_regularity(const Frame& frame) const = 0;
  /// True if the independent loop rows lose rank on the way between two frames: det(B_from B_to^T) < 0, which is the
  /// sum of the products of their minors (Cauchy and Binet).
  virtual bool loops_cross(const Frame& from, const Frame& to) const = 0;
  /// The largest angle by which a body turns between two configurations (step-size limit, numerics 1.8).
  virtual double largest_rotation(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to) const = 0;
};

}  // namespace muldi::model
