#include "fem/solid/turning.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "math/rotation.hpp"

namespace muldi::fem {
namespace {

/// Weights are multiples of 1/steps, so that few different rotations are computed.
constexpr double steps = 64.0;

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

double least_distance(const Eigen::VectorXd& X, int node, const std::vector<int>& to) {
  double least = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d at = X.segment<3>(3 * static_cast<Eigen::Index>(node));
  for (const int other : to) {
    least = std::min(least, (X.segment<3>(3 * static_cast<Eigen::Index>(other)) - at).squaredNorm());
  }
  return std::sqrt(least);
}

}  // namespace

Turning::Turning(const SolidDescription& data) : data_(&data) {
  if (data.ties.empty()) return;
  std::vector<std::vector<int>> anchors(data.hosts.size());
  for (const Tie& tie : data.ties) anchors[static_cast<std::size_t>(tie.host)].push_back(tie.node);
  if (!data.displacements.empty()) {
    anchors.emplace_back();
    for (const PrescribedDisplacement& said : data.displacements) anchors.back().push_back(said.node);
  }
  kept_.assign(data.hosts.size(), Eigen::Matrix3d::Identity());
  rotations_.assign(anchors.size(), Eigen::Matrix3d::Identity());
  logs_.assign(anchors.size(), Eigen::Vector3d::Zero());
  weigh(anchors);
  frames_.assign(weights_.size(), Eigen::Matrix3d::Identity());
}

void Turning::weigh(const std::vector<std::vector<int>>& anchors) {
  std::map<std::vector<int>, int> known;
  const auto n_nodes = static_cast<int>(data_->X.size() / 3);
  frame_of_node_.reserve(static_cast<std::size_t>(n_nodes));
  std::vector<double> distance(anchors.size());
  std::vector<int> rounded(anchors.size());
  for (int node = 0; node < n_nodes; ++node) {
    for (std::size_t k = 0; k < anchors.size(); ++k) distance[k] = least_distance(data_->X, node, anchors[k]);
    double sum = 0.0;
    bool touches = false;
    for (const double d : distance) {
      touches |= d == 0.0;
      sum += 1.0 / d;
    }
    for (std::size_t k = 0; k < anchors.size(); ++k) {
      const double weight = touches ? (distance[k] == 0.0 ? 1.0 : 0.0) : 1.0 / (distance[k] * sum);
      rounded[k] = static_cast<int>(std::lround(steps * weight));
    }
    const auto [at, is_new] = known.emplace(rounded, static_cast<int>(weights_.size()));
    if (is_new) {
      Eigen::VectorXd weights(static_cast<Eigen::Index>(anchors.size()));
      for (std::size_t k = 0; k < anchors.size(); ++k) weights[static_cast<Eigen::Index>(k)] = rounded[k] / steps;
      weights_.push_back(weights);
    }
    frame_of_node_.push_back(at->second);
  }
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
    for (std::size_t k = 1; k < logs_.size(); ++k) sum += weights_[f][static_cast<Eigen::Index>(k)] * logs_[k];
    frames_[f] = rotations_[0] * exp_of(sum);
  }
}

void Turning::back(Eigen::Ref<Eigen::VectorXd> x) const {
  for (std::size_t node = 0; node < frame_of_node_.size(); ++node) {
    auto at = x.segment<3>(3 * static_cast<Eigen::Index>(node));
    at = (frames_[static_cast<std::size_t>(frame_of_node_[node])].transpose() * at).eval();
  }
}

void Turning::forth(Eigen::Ref<Eigen::VectorXd> x) const {
  for (std::size_t node = 0; node < frame_of_node_.size(); ++node) {
    auto at = x.segment<3>(3 * static_cast<Eigen::Index>(node));
    at = (frames_[static_cast<std::size_t>(frame_of_node_[node])] * at).eval();
  }
}

}  // namespace muldi::fem
