#pragma once
/// The contract of constraints: the set of admissible configurations, its null-space matrix, and projected linear
/// systems.
///
/// Configurations are rebuilt from coordinates x (joint angles, slides, unit quaternions, free lengths), so the
/// constraints of a tree hold to round-off in every state (numerics, 1.8 ii). T(q) is the null-space matrix: every
/// admissible velocity is T(q) w with minimal velocities w. T is the identity on unknowns without constraints.
///
/// Loop-closing joints keep rows g(q) = 0 with multipliers lambda (numerics, 1.9). Rows may depend on each other: of
/// B = G T only the range matters. At every node in time an orthonormal basis Z of it is chosen; a step demands
/// Z^T g = 0 with the multipliers mu, and lambda = Z mu is the set of least norm with that constraint force. It does
/// not depend on the basis, so that it may be compared and carried from node to node.
#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "math/block_matrix.hpp"
#include "model/bilinear.hpp"
#include "model/chart.hpp"

namespace muldi::model {

/// T(q) at one configuration, in whatever factored form the manifold likes.
class Frame {
 public:
  virtual ~Frame() = default;
};

/// Factorised projected system of one Newton iteration,
///     [ T_l^T K T_r + D   B_l^T ] [ w  ]   [ r ]
///     [ B_r               0     ] [ mu ] = [ g ],   B = Z^T G T with the loop basis Z of the left frame,
/// D = diag(diagonal).
class ProjectedSolver {
 public:
  virtual ~ProjectedSolver() = default;
  /// False if the system is singular to working precision. Allocates nothing after the first call. The loop rows of
  /// `left` must have been chosen. `diagonal`: (n_v), or empty for none.
  virtual bool factorise(const Frame& left, const Frame& right, const math::BlockMatrix& K,
                         const Eigen::VectorXd& diagonal) = 0;
  bool factorise(const Frame& left, const Frame& right, const math::BlockMatrix& K) {
    return factorise(left, right, K, Eigen::VectorXd());
  }
  /// r (n_v), g (n_c) in; w (n_v), mu (n_c) out.
  virtual void solve(const Eigen::VectorXd& r, const Eigen::VectorXd& g, Eigen::VectorXd& w, Eigen::VectorXd& mu) = 0;
  virtual std::string name() const = 0;
};

/// A body that turns between two configurations.
struct Turn {
  double angle = 0.0;  ///< rad
  int node = -1;       ///< of the model; none: nothing turns
};

/// Rank of the loop rows B = G T at one configuration, by pivoted QR of B in natural increments.
struct LoopRank {
  double regularity = 1.0;  ///< smallest over largest pivot of the n_c that count: 0 where rank is lost
  double excess = 0.0;      ///< the next pivot: not 0 where the rank is above n_c
};

class Manifold {
 public:
  virtual ~Manifold() = default;

  virtual int n_x() const = 0;          ///< stored coordinates
  virtual int n_q() const = 0;          ///< redundant configuration
  virtual int n_v() const = 0;          ///< minimal velocities
  virtual int n_loop_rows() const = 0;  ///< rows of the loop-closing joints
  virtual int n_c() const = 0;          ///< their rank in the scene pose

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

  /// Minimal coordinates around the scene pose.
  virtual std::unique_ptr<Chart> make_chart() const = 0;

  virtual std::unique_ptr<Frame> make_frame() const = 0;
  virtual void update(const Eigen::VectorXd& x, const Eigen::VectorXd& q, Frame& frame) const = 0;
  /// Chooses the basis Z at an updated frame, by the configuration alone. Allocates nothing.
  virtual LoopRank choose_loop_rows(Frame& frame) const = 0;
  /// Z (n_loop_rows, n_c), orthonormal columns; as chosen last.
  virtual const Eigen::MatrixXd& loop_basis(const Frame& frame) const = 0;
  /// r = T^T f; f (n_q), r (n_v).
  virtual void project(const Frame& frame, const Eigen::VectorXd& f, Eigen::VectorXd& r) const = 0;
  /// dq = T w.
  virtual void lift(const Frame& frame, const Eigen::VectorXd& w, Eigen::VectorXd& dq) const = 0;
  /// f += factor times the forces of joint drives: T^T f = `on_rates` (n_v), in equal and opposite pairs on the bodies
  /// of each joint, so that reactions do not contain them; f (n_q).
  virtual void add_forces_on_rates(const Frame& frame, double factor, const Eigen::VectorXd& on_rates,
                                   Eigen::VectorXd& f) const = 0;

  /// g (n_loop_rows): violation of the loop-closing rows; gaps are divided by the size of the scene.
  virtual void constraints(const Eigen::VectorXd& q, Eigen::VectorXd& g) const = 0;
  /// f += factor G(q)^T lambda; lambda (n_loop_rows).
  virtual void add_constraint_forces(const Eigen::VectorXd& q, double factor, const Eigen::VectorXd& lambda,
                                     Eigen::VectorXd& f) const = 0;
  /// The loop-closing rows themselves (n_loop_rows).
  virtual const std::vector<Bilinear>& loop_rows() const = 0;
  /// Largest violation of all constraints, those of the tree included.
  virtual double violation(const Eigen::VectorXd& q) const = 0;

  /// A = T^T K T as a dense matrix (n_v, n_v), and B = Z^T G T (n_c, n_v) for a basis Z (n_loop_rows, n_c).
  virtual void project_tangent(const Frame& left, const Frame& right, const math::BlockMatrix& K,
                               Eigen::MatrixXd& A) const = 0;
  virtual void project_constraints(const Frame& frame, const Eigen::MatrixXd& Z, Eigen::MatrixXd& B) const = 0;
  /// A -= d(T(q)^T f)/dw + sum_i lambda_i T^T (-d2g_i/dq2) T for frozen f and lambda: the curvature of the manifold,
  /// which statics and modes need (numerics, 4.5). `f` is the total force including constraint forces;
  /// lambda (n_loop_rows).
  virtual void add_curvature(const Frame& frame, const Eigen::VectorXd& f, const Eigen::VectorXd& lambda,
                             Eigen::MatrixXd& A) const = 0;

  /// `kind`: auto | tree | dense | bordered. InputError when the wanted kind cannot solve this system.
  virtual std::unique_ptr<ProjectedSolver> make_solver(const math::BlockPattern& pattern,
                                                       const std::string& kind) const = 0;

  /// True if the loop rows lose rank on the way between two frames: det(B_from B_to^T) < 0 with the basis chosen at
  /// `from`, which is the sum of the products of the minors of all rows (Cauchy and Binet).
  virtual bool loops_cross(const Frame& from, const Frame& to) const = 0;
  /// The largest angle by which a body turns between two configurations (step-size limit, numerics 1.8), and which.
  virtual Turn largest_turn(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to) const = 0;
  double largest_rotation(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to) const {
    return largest_turn(q_from, q_to).angle;
  }
};

}  // namespace muldi::model
