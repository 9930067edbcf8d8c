#include "multibody/rigid_body.hpp"

#include "multibody/joint.hpp"

namespace muldi::multibody {

RigidBodies::RigidBodies(std::vector<RigidBody> bodies, const Eigen::Vector3d& gravity)
    : bodies_(std::move(bodies)), gravity_(gravity) {
  for (const RigidBody& body : bodies_) euler_.push_back(body.euler_tensor());
}

void RigidBodies::bind(const math::BlockPattern& pattern) {
  slots_.clear();
  for (int i = 0; i < static_cast<int>(bodies_.size()); ++i) slots_.push_back(pattern.slot(i, i));
}

void RigidBodies::add_forces(const model::IntervalPoint& at, model::IntervalForces& out) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto first = static_cast<Eigen::Index>(12 * i);
    out.force.segment<3>(first) += bodies_[i].mass * gravity_;
    out.momentum.segment<3>(first) += bodies_[i].mass * at.v.segment<3>(first);
    const Eigen::Map<const Eigen::Matrix3d> rates(at.v.data() + first + 3);
    Eigen::Map<Eigen::Matrix3d>(out.momentum.data() + first + 3) += rates.lazyProduct(euler_[i]);
  }
}

void RigidBodies::add_tangent(const model::IntervalPoint&, const model::TangentWeights& weights,
                              math::BlockMatrix& K) const {
  if (weights.vv == 0.0) return;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    double* const block = K.data(slots_[i]);
    const std::ptrdiff_t stride = slots_[i].stride;
    for (int k = 0; k < 3; ++k) {
      block[k * stride + k] += weights.vv * bodies_[i].mass;
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          block[(3 + 3 * a + k) * stride + 3 + 3 * b + k] += weights.vv * euler_[i](a, b);
        }
      }
    }
  }
}

void RigidBodies::add_constant_mass(std::vector<model::MassEntry>& mass) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const int body = static_cast<int>(i);
    const model::LinearPoint centre = body_point(body, Eigen::Vector3d::Zero());
    mass.push_back({centre, centre, bodies_[i].mass});
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        if (euler_[i](a, b) == 0.0) continue;
        mass.push_back({body_direction(body, Eigen::Vector3d::Unit(a)), body_direction(body, Eigen::Vector3d::Unit(b)),
                        euler_[i](a, b)});
      }
    }
  }
}

std::vector<std::string> RigidBodies::parts() const {
  std::vector<std::string> names;
  for (const RigidBody& body : bodies_) names.push_back("bodies/" + body.name);
  return names;
}

void RigidBodies::energies(const model::NodePoint& at, std::span<model::Energy> out) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto first = static_cast<Eigen::Index>(12 * i);
    const Eigen::Map<const Eigen::Matrix3d> rates(at.v.data() + first + 3);
    out[i].kinetic += 0.5 * bodies_[i].mass * at.v.segment<3>(first).squaredNorm() +
                      0.5 * rates.lazyProduct(euler_[i]).cwiseProduct(rates).sum();
    out[i].gravity -= bodies_[i].mass * gravity_.dot(at.q.segment<3>(first));
  }
}

}  // namespace muldi::multibody
