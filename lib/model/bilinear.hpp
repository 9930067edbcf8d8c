#pragma once
/// Scalar functions scale (a(q) . b(q) - constant) of two linear points: every joint constraint and joint coordinate is
/// built from them, with affine gradients and constant Hessians (numerics, 1.7).
#include "math/block_matrix.hpp"
#include "model/linear_point.hpp"

namespace muldi::model {

struct Bilinear {
  LinearPoint a;
  LinearPoint b;
  double constant = 0.0;
  double scale = 1.0;

  double value(const Eigen::VectorXd& q) const { return scale * (a.value(q).dot(b.value(q)) - constant); }

  /// Directional derivative along v.
  double rate(const Eigen::VectorXd& q, const Eigen::VectorXd& v) const {
    return scale * (a.rate(v).dot(b.value(q)) + a.value(q).dot(b.rate(v)));
  }

  /// f += factor grad.
  void add_gradient(const Eigen::VectorXd& q, double factor, Eigen::VectorXd& f) const {
    a.add_transposed(scale * factor * b.value(q), f);
    b.add_transposed(scale * factor * a.value(q), f);
  }

  /// f += factor Hessian v.
  void add_hessian_times(const Eigen::VectorXd& v, double factor, Eigen::VectorXd& f) const {
    a.add_transposed(scale * factor * b.rate(v), f);
    b.add_transposed(scale * factor * a.rate(v), f);
  }
};

}  // namespace muldi::model
