#include "fem/solid/turning.hpp"

#include <Eigen/Geometry>
#include <array>

#include "math/rotation.hpp"

namespace muldi::fem {
namespace {

Eigen::Matrix3d directors(const Eigen::VectorXd& q, const Host& host) {
  Eigen::Matrix3d R;
  for (int i = 0; i < 3; ++i) R.col(i) = q.segment<3>(host.first + 3 + 3 * i);
  return R;
}

Eigen::Vector3d log_of(const Eigen::Matrix3d& R) {
  std::array<double, 4> quaternion{};
  math::matrix_quaternion(R, quaternion.data());
  return math::quaternion_log(quaternion.data());
}

Eigen::Matrix3d exp_of(const Eigen::Vector3d& rotation_vector) {
  std::array<double, 4> quaternion{};
  math::quaternion_exp(rotation_vector, quaternion.data());
  return math::quaternion_matrix(quaternion.data());
}

}  // namespace

Turning::Turning(const SolidDescription& data) : data_(&data), weights_(data) {
  if (data.ties.empty()) return;
  kept_.assign(data.hosts.size(), Eigen::Matrix3d::Identity());
  rotations_.assign(weights_.n_anchors, Eigen::Matrix3d::Identity());
  logs_.assign(weights_.n_anchors, Eigen::Vector3d::Zero());
  frames_.assign(weights_.weights.size(), Eigen::Matrix3d::Identity());
}

void Turning::keep(const Eigen::VectorXd& q) {
  for (std::size_t h = 0; h < kept_.size(); ++h) kept_[h] = directors(q, data_->hosts[h]);
  turned_ = false;
}

void Turning::turn_to(const Eigen::VectorXd& q) {
  turned_ = false;
  for (std::size_t h = 0; h < kept_.size(); ++h) {
    const Eigen::Matrix3d now = directors(q, data_->hosts[h]);
    turned_ |= now != kept_[h];
    rotations_[h] = now * kept_[h].transpose();
  }
  if (!turned_) return;
  for (std::size_t k = 1; k < rotations_.size(); ++k) logs_[k] = log_of(rotations_[0].transpose() * rotations_[k]);
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = 1; k < logs_.size(); ++k) sum += weights_.weights[f][static_cast<Eigen::Index>(k)] * logs_[k];
    frames_[f] = rotations_[0] * exp_of(sum);
  }
}

void Turning::back(Eigen::Ref<Eigen::VectorXd> x) const {
  for (std::size_t node = 0; node < weights_.group_of_node.size(); ++node) {
    auto at = x.segment<3>(3 * static_cast<Eigen::Index>(node));
    at = (frames_[static_cast<std::size_t>(weights_.group_of_node[node])].transpose() * at).eval();
  }
}

void Turning::forth(Eigen::Ref<Eigen::VectorXd> x) const {
  for (std::size_t node = 0; node < weights_.group_of_node.size(); ++node) {
    auto at = x.segment<3>(3 * static_cast<Eigen::Index>(node));
    at = (frames_[static_cast<std::size_t>(weights_.group_of_node[node])] * at).eval();
  }
}

}  // namespace muldi::fem
