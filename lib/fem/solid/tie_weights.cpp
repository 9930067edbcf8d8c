#include "fem/solid/tie_weights.hpp"

#include <cmath>
#include <limits>
#include <map>

namespace muldi::fem {
namespace {

/// Weights are multiples of 1/steps, so that few different rotations are computed.
constexpr double steps = 64.0;

double least_distance(const Eigen::VectorXd& X, int node, const std::vector<int>& to) {
  double least = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d at = X.segment<3>(3 * static_cast<Eigen::Index>(node));
  for (const int other : to) {
    least = std::min(least, (X.segment<3>(3 * static_cast<Eigen::Index>(other)) - at).squaredNorm());
  }
  return std::sqrt(least);
}

/// Weights of a node times `steps`, from its distances to the anchors.
std::vector<int> rounded_weights(const std::vector<double>& distance) {
  double sum = 0.0;
  bool touches = false;
  for (const double d : distance) {
    touches |= d == 0.0;
    sum += 1.0 / d;
  }
  std::vector<int> rounded(distance.size());
  for (std::size_t k = 0; k < distance.size(); ++k) {
    const double weight = touches ? (distance[k] == 0.0 ? 1.0 : 0.0) : 1.0 / (distance[k] * sum);
    rounded[k] = static_cast<int>(std::lround(steps * weight));
  }
  return rounded;
}

}  // namespace

TieWeights::TieWeights(const SolidDescription& data) {
  if (data.ties.empty()) return;
  std::vector<std::vector<int>> anchors(data.hosts.size());
  for (const Tie& tie : data.ties) anchors[static_cast<std::size_t>(tie.host)].push_back(tie.node);
  if (!data.displacements.empty()) {
    anchors.emplace_back();
    for (const PrescribedDisplacement& said : data.displacements) anchors.back().push_back(said.node);
  }
  n_anchors = anchors.size();
  std::map<std::vector<int>, int> known;
  const auto n_nodes = static_cast<int>(data.X.size() / 3);
  group_of_node.reserve(static_cast<std::size_t>(n_nodes));
  std::vector<double> distance(n_anchors);
  for (int node = 0; node < n_nodes; ++node) {
    for (std::size_t k = 0; k < n_anchors; ++k) distance[k] = least_distance(data.X, node, anchors[k]);
    const std::vector<int> rounded = rounded_weights(distance);
    const auto [at, is_new] = known.emplace(rounded, static_cast<int>(weights.size()));
    if (is_new) {
      Eigen::VectorXd one(static_cast<Eigen::Index>(n_anchors));
      for (std::size_t k = 0; k < n_anchors; ++k) one[static_cast<Eigen::Index>(k)] = rounded[k] / steps;
      weights.push_back(one);
    }
    group_of_node.push_back(at->second);
  }
}

}  // namespace muldi::fem
