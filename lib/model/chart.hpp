#pragma once
/// Smooth minimal coordinates theta of a manifold around a reference, for optimal control: the joint coordinates, of
/// balls the rotation vector from their reference orientation. theta has as many entries as the minimal velocities.
#include <Eigen/Core>
#include <memory>
#include <vector>

namespace muldi::model {

/// The configuration and its derivatives at theta along a direction mu. Entries of columns that a row does not depend
/// on are 0.
struct ChartPoint {
  Eigen::VectorXd q;  ///< q(theta) (n_q)
  Eigen::MatrixXd D;  ///< dq/dtheta (n_q, n_v)
  Eigen::VectorXd a;  ///< D mu (n_q)
  Eigen::MatrixXd A;  ///< da/dtheta at fixed mu (n_q, n_v)
};

class Chart {
 public:
  virtual ~Chart() = default;

  /// Measures the rotations of balls from their orientations in x (n_x). The least smooth place is a turn of 2 pi from
  /// there.
  virtual void set_reference(const Eigen::VectorXd& x) = 0;
  /// theta of x; angles keep their turns.
  virtual void coordinates(const Eigen::VectorXd& x, Eigen::VectorXd& theta) const = 0;
  /// x of theta.
  virtual void stored(const Eigen::VectorXd& theta, Eigen::VectorXd& x) const = 0;
  /// True if theta_k is a coordinate that users read, not an entry of a rotation vector.
  virtual bool is_coordinate(int k) const = 0;
  /// Entries of theta that unknown `dof` of q depends on, ascending.
  virtual const std::vector<int>& columns_of(int dof) const = 0;

  /// q and D; a and A are not touched.
  virtual void evaluate(const Eigen::VectorXd& theta, ChartPoint& out) = 0;
  /// All of the point along `mu` (n_v), and what add_curvature needs.
  virtual void evaluate_along(const Eigen::VectorXd& theta, const Eigen::VectorXd& mu, ChartPoint& out) = 0;
  /// H += d2/dtheta2 (y . q) for frozen y (n_q) at the last evaluate; H (n_v, n_v), both triangles.
  virtual void add_curvature(const Eigen::VectorXd& y, Eigen::Ref<Eigen::MatrixXd> H) = 0;
  /// H += d2/dtheta2 (y . q + b . a) for frozen y, b (n_q) at the last evaluate_along.
  virtual void add_curvature_along(const Eigen::VectorXd& y, const Eigen::VectorXd& b,
                                   Eigen::Ref<Eigen::MatrixXd> H) = 0;
};

}  // namespace muldi::model
