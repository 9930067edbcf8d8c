#pragma once
/// A scalar coordinate c(q) that no unknown is: that of a loop-closing joint. Forces on it act at the two ends of an
/// interval, as those on the coordinates of other joints do: the optimal control differentiates them through c.
#include <Eigen/Core>
#include <vector>

namespace muldi::model {

/// Derivatives of c at one configuration, by the n unknowns that it depends on.
struct EndDerivatives {
  Eigen::VectorXd gradient;       ///< (n)
  Eigen::MatrixXd hessian;        ///< (n, n)
  Eigen::MatrixXd hessian_slope;  ///< d/d eps of the Hessian at q + eps a (n, n)
};

class EndCoordinate {
 public:
  virtual ~EndCoordinate() = default;

  /// The n unknowns of q that c depends on.
  virtual std::vector<int> unknowns() const = 0;
  virtual bool is_angle() const = 0;
  /// c(q) - from, of angles the short way round.
  virtual double offset(const Eigen::VectorXd& q, double from) const = 0;
  /// c(q1) - c(q0), of angles the short way round.
  virtual double advance(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1) const = 0;
  /// `a` (n_q): the direction of the slope; null: none is asked for.
  virtual void differentiate(const Eigen::VectorXd& q, const Eigen::VectorXd* a, EndDerivatives& out) const = 0;
};

}  // namespace muldi::model
