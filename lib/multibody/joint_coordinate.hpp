#pragma once
/// A scalar joint coordinate as a function of q, with gradient and Hessian: springs, dampers, drives and stops of
/// loop-closing joints act on it.
#include <array>
#include <span>

#include "model/bilinear.hpp"
#include "model/end_coordinate.hpp"
#include "multibody/joint.hpp"

namespace muldi::multibody {

/// A slide z = e_axis^A . p - z_0, or an angle theta = atan2(S, C) with S, C sums of products e_a^A . e_b^B.
class JointCoordinate final : public model::EndCoordinate {
 public:
  /// `motion` must not be a ball.
  JointCoordinate(const Joint& joint, const Motion& motion);

  /// Angles are in (-pi, pi].
  double value(const Eigen::VectorXd& q) const;
  double rate(const Eigen::VectorXd& q, const Eigen::VectorXd& v) const;
  /// f += factor grad.
  void add_gradient(const Eigen::VectorXd& q, double factor, Eigen::VectorXd& f) const;

  /// Unknowns of the (one or two) bodies: at most 24, those of nodes()[0] come first.
  std::span<const int> nodes() const { return {nodes_.data(), static_cast<std::size_t>(n_nodes_)}; }
  static constexpr int max_size = 24;
  using LocalVector = Eigen::Matrix<double, max_size, 1>;
  using LocalMatrix = Eigen::Matrix<double, max_size, max_size>;
  /// Gradient and Hessian in local unknowns (node by node).
  LocalVector gradient(const Eigen::VectorXd& q) const;
  LocalMatrix hessian(const Eigen::VectorXd& q) const;
  /// d/d eps of the Hessian at q + eps a.
  LocalMatrix hessian_slope(const Eigen::VectorXd& q, const Eigen::VectorXd& a) const;

  std::vector<int> unknowns() const override;
  bool is_angle() const override { return is_angle_; }
  double offset(const Eigen::VectorXd& q, double from) const override;
  double advance(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1) const override;
  void differentiate(const Eigen::VectorXd& q, const Eigen::VectorXd* a, model::EndDerivatives& out) const override;

 private:
  struct Product {
    model::Bilinear form;
    double sign = 0.0;
  };
  struct SineCosine {
    double sine;
    double cosine;
  };
  SineCosine sine_cosine(const Eigen::VectorXd& q) const;
  /// Local gradients of S and C.
  void sine_cosine_gradients(const Eigen::VectorXd& q, LocalVector& of_sine, LocalVector& of_cosine) const;
  void local_gradient(const model::Bilinear& form, const Eigen::VectorXd& q, double factor, LocalVector& out) const;
  void local_hessian(const model::Bilinear& form, double factor, LocalMatrix& out) const;
  /// Local Hessians of S and C, which do not depend on q.
  void sine_cosine_hessians(LocalMatrix& of_sine, LocalMatrix& of_cosine) const;
  int local(int node, int dof) const { return dof - 12 * node + (nodes_[0] == node ? 0 : 12); }

  bool is_angle_ = false;
  model::Bilinear slide_;
  std::array<Product, 2> sine_{};
  std::array<Product, 2> cosine_{};
  std::array<int, 2> nodes_{-1, -1};
  int n_nodes_ = 0;
};

}  // namespace muldi::multibody
