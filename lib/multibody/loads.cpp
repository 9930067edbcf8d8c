#include "multibody/loads.hpp"

#include <Eigen/Geometry>
#include <array>

#include "base/mutation.hpp"
#include "math/rotation.hpp"

namespace muldi::multibody {
namespace {

/// Weights of phi, d1, d2, d3 in the position of a point.
Eigen::Vector4d weights_of(const Eigen::Vector3d& point) { return {1.0, point.x(), point.y(), point.z()}; }

Eigen::Vector3d world_direction(const Load& load, const Eigen::VectorXd& q) {
  if (load.frame == Load::Frame::world) return load.direction;
  return Eigen::Map<const Eigen::Matrix3d>(q.data() + 12 * load.body + 3) * load.direction;
}

}  // namespace

Loads::LocalForce Loads::unit_force(const Load& load, const Eigen::VectorXd& q) {
  const Eigen::Vector3d direction = world_direction(load, q);
  LocalForce f = LocalForce::Zero();
  if (load.kind == Load::Kind::force) {
    const Eigen::Vector4d weights = weights_of(load.point);
    for (int k = 0; k < 4; ++k) f.segment<3>(3 * k) = weights[k] * direction;
  } else {
    // sum d_i x (tau x d_i)/2 = tau: the torque as forces on the directors.
    for (int k = 0; k < 3; ++k) {
      f.segment<3>(3 + 3 * k) = 0.5 * direction.cross(Eigen::Vector3d(q.segment<3>(12 * load.body + 3 + 3 * k)));
    }
  }
  return f;
}

void Loads::bind(const math::BlockPattern& pattern) {
  slots_.clear();
  for (const Load& load : loads_) slots_.push_back(pattern.slot(load.body, load.body));
}

void Loads::add_forces(const model::IntervalPoint& at, model::IntervalForces& out) const {
  for (const Load& load : loads_) {
    out.force.segment<12>(12 * load.body) += base::times_missing_half() * load.magnitude(at.u) * unit_force(load, at.q);
  }
}

Loads::LocalMatrix Loads::unit_slope(const Load& load, const Eigen::VectorXd& q) {
  LocalMatrix slope = LocalMatrix::Zero();
  const bool follows = load.frame == Load::Frame::body;
  if (load.kind == Load::Kind::force) {
    if (!follows) return slope;
    const Eigen::Vector4d w = weights_of(load.point);
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 3; ++j) slope.block<3, 3>(3 * i, 3 + 3 * j).diagonal().array() += w[i] * load.direction[j];
    }
    return slope;
  }
  const Eigen::Matrix3d turn = 0.5 * math::hat(world_direction(load, q));
  for (int i = 0; i < 3; ++i) {
    slope.block<3, 3>(3 + 3 * i, 3 + 3 * i) += turn;
    if (!follows) continue;
    const Eigen::Matrix3d d = 0.5 * math::hat(Eigen::Vector3d(q.segment<3>(12 * load.body + 3 + 3 * i)));
    for (int j = 0; j < 3; ++j) slope.block<3, 3>(3 + 3 * i, 3 + 3 * j) -= load.direction[j] * d;
  }
  return slope;
}

void Loads::add_tangent(const model::IntervalPoint& at, const model::TangentWeights& weights,
                        math::BlockMatrix& K) const {
  if (weights.qq == 0.0) return;
  for (std::size_t l = 0; l < loads_.size(); ++l) {
    const Load& load = loads_[l];
    Eigen::Map<Eigen::Matrix<double, 12, 12, Eigen::RowMajor>, 0, Eigen::OuterStride<>> block(
        K.data(slots_[l]), Eigen::OuterStride<>(slots_[l].stride));
    block += weights.qq * load.magnitude(at.u) * unit_slope(load, at.q);
  }
}

bool Loads::expand(const model::IntervalPoint& at, const model::ExpansionRequest& request,
                   model::ExpansionSink& sink) const {
  Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(24, 25);
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(25, 25);
  std::array<int, 12> entries{};
  for (const Load& load : loads_) {
    const int first = 12 * load.body;
    for (int k = 0; k < 12; ++k) entries[static_cast<std::size_t>(k)] = first + k;
    // With a drive squared the force is magnitude(u) with u^2 as the variable, which is not affine.
    if (load.control >= 0 && request.squared[static_cast<std::size_t>(load.control)] != 0.0) return false;
    const double magnitude = load.magnitude(at.u);
    const double slope = load.control < 0 ? 0.0 : load.control_factor;
    tangent.topLeftCorner<12, 12>() = magnitude * unit_slope(load, at.q);
    tangent.block<12, 1>(0, 24) = slope * unit_force(load, at.q);
    if (request.a != nullptr) {
      const Eigen::Matrix<double, 12, 1> a = request.a->segment<12>(first);
      const Eigen::Matrix<double, 12, 1> by_control = slope * unit_slope(load, at.q).transpose() * a;
      hessian.block<12, 1>(0, 24) = by_control;
      hessian.block<1, 12>(24, 0) = by_control.transpose();
      // The slope is linear in q: its derivatives are differences.
      LocalMatrix bend = LocalMatrix::Zero();
      if (load.kind == Load::Kind::torque && load.frame == Load::Frame::body) {
        Eigen::VectorXd unit = Eigen::VectorXd::Zero(at.q.size());
        for (int k = 3; k < 12; ++k) {
          unit[first + k] = 1.0;
          bend.col(k) = magnitude * unit_slope(load, unit).transpose() * a;
          unit[first + k] = 0.0;
        }
      }
      hessian.topLeftCorner<12, 12>() = bend;
    }
    const int control = load.control;
    sink.add({.entries = entries},
             {.controls = {&control, 1}, .tangent = tangent, .hessian = request.a != nullptr ? &hessian : nullptr});
  }
  return true;
}

void Loads::add_control_force(const model::IntervalPoint& at, int control, Eigen::VectorXd& out) const {
  for (const Load& load : loads_) {
    if (load.control == control) out.segment<12>(12 * load.body) += load.control_factor * unit_force(load, at.q);
  }
}

model::IntervalWork Loads::work(const model::IntervalPoint& at) const {
  model::IntervalWork work;
  for (const Load& load : loads_) {
    work.external += at.dt * load.magnitude(at.u) * unit_force(load, at.q).dot(at.v.segment<12>(12 * load.body));
  }
  return work;
}

}  // namespace muldi::multibody
