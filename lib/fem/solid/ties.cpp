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

}  // namespace muldi::fem
