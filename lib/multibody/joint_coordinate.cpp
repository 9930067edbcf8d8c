#include "multibody/joint_coordinate.hpp"

#include <cmath>
#include <numbers>

#include "base/error.hpp"

namespace muldi::multibody {

JointCoordinate::JointCoordinate(const Joint& joint, const Motion& motion) : is_angle_(motion.is_angle()) {
  MULDI_EXPECT(motion.kind != Motion::Kind::ball, "a ball has no scalar coordinates");
  for (const int body : {joint.body_a, joint.body_b}) {
    if (body != ground) nodes_[static_cast<std::size_t>(n_nodes_++)] = body;
  }
  const auto e_a = [&](int k) { return body_direction(joint.body_a, joint.triad_a.col(k)); };
  const auto e_b = [&](int k) { return body_direction(joint.body_b, joint.triad_b.col(k)); };
  if (!is_angle_) {
    slide_ = {.a = e_a(motion.axis),
              .b = body_point(joint.body_b, joint.rho_b) - body_point(joint.body_a, joint.rho_a),
              .constant = joint.offset[motion.axis]};
    return;
  }
  for (std::size_t k = 0; k < 2; ++k) {
    sine_[k] = {{.a = e_a(motion.sine[k].a), .b = e_b(motion.sine[k].b)}, motion.sine[k].sign};
    cosine_[k] = {{.a = e_a(motion.cosine[k].a), .b = e_b(motion.cosine[k].b)}, motion.cosine[k].sign};
  }
}

JointCoordinate::SineCosine JointCoordinate::sine_cosine(const Eigen::VectorXd& q) const {
  SineCosine result{0.0, 0.0};
  for (const Product& product : sine_) result.sine += product.sign == 0.0 ? 0.0 : product.sign * product.form.value(q);
  for (const Product& product : cosine_) {
    result.cosine += product.sign == 0.0 ? 0.0 : product.sign * product.form.value(q);
  }
  return result;
}

double JointCoordinate::value(const Eigen::VectorXd& q) const {
  if (!is_angle_) return slide_.value(q);
  const auto [sine, cosine] = sine_cosine(q);
  return std::atan2(sine, cosine);
}

void JointCoordinate::local_gradient(const model::Bilinear& form, const Eigen::VectorXd& q, double factor,
                                     LocalVector& out) const {
  const auto add = [&](const model::LinearPoint& point, const Eigen::Vector3d& direction) {
    for (int k = 0; k < point.n; ++k) {
      const auto at = static_cast<std::size_t>(k);
      out.segment<3>(local(point.node[at], point.dof[at])) += factor * point.weight[at] * direction;
    }
  };
  add(form.a, form.b.value(q));
  add(form.b, form.a.value(q));
}

void JointCoordinate::local_hessian(const model::Bilinear& form, double factor, LocalMatrix& out) const {
  for (int i = 0; i < form.a.n; ++i) {
    for (int j = 0; j < form.b.n; ++j) {
      const auto a = static_cast<std::size_t>(i);
      const auto b = static_cast<std::size_t>(j);
      const double weight = factor * form.a.weight[a] * form.b.weight[b];
      const int row = local(form.a.node[a], form.a.dof[a]);
      const int column = local(form.b.node[b], form.b.dof[b]);
      for (int k = 0; k < 3; ++k) {
        out(row + k, column + k) += weight;
        out(column + k, row + k) += weight;
      }
    }
  }
}

void JointCoordinate::sine_cosine_gradients(const Eigen::VectorXd& q, LocalVector& of_sine,
                                            LocalVector& of_cosine) const {
  of_sine.setZero();
  of_cosine.setZero();
  for (const Product& product : sine_) {
    if (product.sign != 0.0) local_gradient(product.form, q, product.sign, of_sine);
  }
  for (const Product& product : cosine_) {
    if (product.sign != 0.0) local_gradient(product.form, q, product.sign, of_cosine);
  }
}

JointCoordinate::LocalVector JointCoordinate::gradient(const Eigen::VectorXd& q) const {
  LocalVector result = LocalVector::Zero();
  if (!is_angle_) {
    local_gradient(slide_, q, 1.0, result);
    return result;
  }
  // theta = atan2(S, C): grad = (C S' - S C')/(S^2 + C^2).
  const auto [S, C] = sine_cosine(q);
  LocalVector grad_S;
  LocalVector grad_C;
  sine_cosine_gradients(q, grad_S, grad_C);
  result = (C * grad_S - S * grad_C) / (S * S + C * C);
  return result;
}

JointCoordinate::LocalMatrix JointCoordinate::hessian(const Eigen::VectorXd& q) const {
  LocalMatrix result = LocalMatrix::Zero();
  if (!is_angle_) {
    local_hessian(slide_, 1.0, result);
    return result;
  }
  // (C S'' - S C'')/r2 - 2 sym(grad (x) (S S' + C C'))/r2, r2 = S^2 + C^2.
  const auto [S, C] = sine_cosine(q);
  const double r2 = S * S + C * C;
  for (const Product& product : sine_) {
    if (product.sign != 0.0) local_hessian(product.form, product.sign * C / r2, result);
  }
  for (const Product& product : cosine_) {
    if (product.sign != 0.0) local_hessian(product.form, -product.sign * S / r2, result);
  }
  LocalVector grad_S;
  LocalVector grad_C;
  sine_cosine_gradients(q, grad_S, grad_C);
  const LocalVector slope = (C * grad_S - S * grad_C) / r2;
  const LocalVector radial = (S * grad_S + C * grad_C) / r2;
  result.noalias() -= slope * radial.transpose() + radial * slope.transpose();
  return result;
}

void JointCoordinate::sine_cosine_hessians(LocalMatrix& of_sine, LocalMatrix& of_cosine) const {
  of_sine.setZero();
  of_cosine.setZero();
  for (const Product& product : sine_) {
    if (product.sign != 0.0) local_hessian(product.form, product.sign, of_sine);
  }
  for (const Product& product : cosine_) {
    if (product.sign != 0.0) local_hessian(product.form, product.sign, of_cosine);
  }
}

JointCoordinate::LocalMatrix JointCoordinate::hessian_slope(const Eigen::VectorXd& q, const Eigen::VectorXd& a) const {
  LocalMatrix result = LocalMatrix::Zero();
  if (!is_angle_) return result;
  const auto [S, C] = sine_cosine(q);
  const double r2 = S * S + C * C;
  LocalVector grad_S;
  LocalVector grad_C;
  LocalMatrix hess_S;
  LocalMatrix hess_C;
  sine_cosine_gradients(q, grad_S, grad_C);
  sine_cosine_hessians(hess_S, hess_C);
  LocalVector along = LocalVector::Zero();
  for (std::size_t i = 0; i < nodes().size(); ++i) {
    along.segment<12>(static_cast<Eigen::Index>(12 * i)) = a.segment<12>(12 * nodes_[i]);
  }
  // Slopes along a of all that the Hessian is made of.
  const double dS = grad_S.dot(along);
  const double dC = grad_C.dot(along);
  const double dr2 = 2.0 * (S * dS + C * dC) / r2;
  const LocalVector d_grad_S = hess_S * along;
  const LocalVector d_grad_C = hess_C * along;
  const LocalVector slope = (C * grad_S - S * grad_C) / r2;
  const LocalVector radial = (S * grad_S + C * grad_C) / r2;
  const LocalVector d_slope = (dC * grad_S + C * d_grad_S - dS * grad_C - S * d_grad_C) / r2 - dr2 * slope;
  const LocalVector d_radial = (dS * grad_S + S * d_grad_S + dC * grad_C + C * d_grad_C) / r2 - dr2 * radial;
  const LocalMatrix half = d_slope * radial.transpose() + slope * d_radial.transpose();
  result = ((dC - dr2 * C) * hess_S - (dS - dr2 * S) * hess_C) / r2 - half - half.transpose();
  return result;
}

std::vector<int> JointCoordinate::unknowns() const {
  std::vector<int> all;
  for (const int node : nodes()) {
    for (int k = 0; k < 12; ++k) all.push_back(12 * node + k);
  }
  return all;
}

double JointCoordinate::offset(const Eigen::VectorXd& q, double from) const {
  const double difference = value(q) - from;
  return is_angle_ ? std::remainder(difference, 2.0 * std::numbers::pi) : difference;
}

double JointCoordinate::advance(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1) const {
  return offset(q1, value(q0));
}

void JointCoordinate::differentiate(const Eigen::VectorXd& q, const Eigen::VectorXd* a,
                                    model::EndDerivatives& out) const {
  const Eigen::Index n = 12 * n_nodes_;
  out.gradient = gradient(q).head(n);
  out.hessian = hessian(q).topLeftCorner(n, n);
  if (a != nullptr) out.hessian_slope = hessian_slope(q, *a).topLeftCorner(n, n);
}

double JointCoordinate::rate(const Eigen::VectorXd& q, const Eigen::VectorXd& v) const {
  if (!is_angle_) return slide_.rate(q, v);
  const auto [S, C] = sine_cosine(q);
  double rate = 0.0;
  for (const Product& product : sine_) rate += product.sign == 0.0 ? 0.0 : C * product.sign * product.form.rate(q, v);
  for (const Product& product : cosine_) rate -= product.sign == 0.0 ? 0.0 : S * product.sign * product.form.rate(q, v);
  return rate / (S * S + C * C);
}

void JointCoordinate::add_gradient(const Eigen::VectorXd& q, double factor, Eigen::VectorXd& f) const {
  if (!is_angle_) {
    slide_.add_gradient(q, factor, f);
    return;
  }
  const auto [S, C] = sine_cosine(q);
  const double r2 = S * S + C * C;
  for (const Product& product : sine_) {
    if (product.sign != 0.0) product.form.add_gradient(q, factor * product.sign * C / r2, f);
  }
  for (const Product& product : cosine_) {
    if (product.sign != 0.0) product.form.add_gradient(q, -factor * product.sign * S / r2, f);
  }
}

}  // namespace muldi::multibody
