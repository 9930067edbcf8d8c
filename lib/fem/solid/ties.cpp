#include "fem/solid/ties.hpp"

namespace muldi::fem {

void Ties::follow(Eigen::Index first, Eigen::VectorXd& q) const {
  for (const Tie& tie : data_->ties) {
    const Eigen::Index body = data_->hosts[static_cast<std::size_t>(tie.host)].first;
    const Eigen::Vector3d at = q.segment<3>(body) + tie.xi[0] * q.segment<3>(body + 3) +
                               tie.xi[1] * q.segment<3>(body + 6) + tie.xi[2] * q.segment<3>(body + 9);
    q.segment<3>(first + 3 * static_cast<Eigen::Index>(tie.node)) = at;
  }
}

void Ties::gather(Eigen::Index first, Eigen::VectorXd& rows) const {
  for (const Tie& tie : data_->ties) {
    const Eigen::Index body = data_->hosts[static_cast<std::size_t>(tie.host)].first;
    const Eigen::Vector3d row = rows.segment<3>(first + 3 * static_cast<Eigen::Index>(tie.node));
    rows.segment<3>(body) += row;
    for (int i = 0; i < 3; ++i) rows.segment<3>(body + 3 + 3 * i) += tie.xi[i] * row;
  }
}

void Ties::add_shared(Eigen::Index first, const Eigen::VectorXd& q, const Eigen::VectorXd& motion, double factor,
                      Eigen::Ref<Eigen::VectorXd> positions) const {
  if (empty()) return;
  for (std::size_t node = 0; node < weights_.group_of_node.size(); ++node) {
    const auto at = 3 * static_cast<Eigen::Index>(node);
    const Eigen::VectorXd& weights = weights_.of_node(node);
    const Eigen::Vector3d x = q.segment<3>(first + at);
    for (int host = 0; host < n_hosts(); ++host) {
      const double weight = factor * weights[host];
      if (weight == 0.0) continue;
      const Eigen::Index body = data_->hosts[static_cast<std::size_t>(host)].first;
      const Eigen::Vector3d lever = x - q.segment<3>(body);
      Eigen::Vector3d moved = motion.segment<3>(body);
      for (Eigen::Index i = body + 3; i < body + host_size; i += 3) {
        moved += lever.dot(q.segment<3>(i)) * motion.segment<3>(i);
      }
      positions.segment<3>(at) += weight * moved;
    }
  }
}

}  // namespace muldi::fem
