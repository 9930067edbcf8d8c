#include "fem/solid/tied_responses.hpp"

namespace muldi::fem {

TiedResponses::TiedResponses(const SolidDescription& data, Eigen::Index n_rows, int block, Eigen::Index n_pressures,
                             math::FactorStorage storage)
    : data_(&data), ties_(data), block_(block), storage_(storage) {
  const Eigen::Index n = ties_.n_columns();
  if (n == 0) return;
  W_ = Eigen::MatrixXd::Zero(n_rows, n);
  KW_ = W_;
  P_ = Eigen::MatrixXd::Zero(n_pressures, n);
  S_ = Eigen::MatrixXd::Zero(n, n);
  turned_S_ = S_;
  answer_ = Eigen::VectorXd::Zero(n);
  of_bodies_ = answer_;
}

void TiedResponses::impose() {
  W_.setZero();
  for (int j = 0; j < n_columns(); ++j) {
    ties_.each_entry(j, [&](int node, int component, double value) {
      W_(static_cast<Eigen::Index>(block_) * node + component, j) = value;
    });
  }
}

void TiedResponses::condense(const math::SymmetricBlockMatrix& K) {
  for (Eigen::Index j = 0; j < W_.cols(); ++j) K.multiply(W_.col(j), KW_.col(j));
  S_.noalias() = W_.transpose() * KW_;
  S_ = (0.5 * (S_ + S_.transpose())).eval();
  if (storage_ == math::FactorStorage::double_precision) return;
  float_W_ = W_.cast<float>();
  float_P_ = P_.cast<float>();
}

void TiedResponses::add_displacements(Eigen::VectorXd& x) {
  if (storage_ == math::FactorStorage::double_precision) {
    x.noalias() += W_ * of_bodies_;
    return;
  }
  float_columns_ = of_bodies_.cast<float>();
  float_rows_.noalias() = float_W_ * float_columns_;
  x += float_rows_.cast<double>();
}

void TiedResponses::add_pressures(Eigen::VectorXd& p) {
  if (storage_ == math::FactorStorage::double_precision) {
    p.noalias() += P_ * of_bodies_;
    return;
  }
  float_columns_ = of_bodies_.cast<float>();
  float_pressures_.noalias() = float_P_ * float_columns_;
  p += float_pressures_.cast<double>();
}

void TiedResponses::answer(const Turning& turning, const Eigen::VectorXd& b, const Eigen::VectorXd& h) {
  if (storage_ == math::FactorStorage::single_precision) {
    float_rows_ = b.cast<float>();
    float_columns_.noalias() = float_W_.transpose() * float_rows_;
    if (P_.rows() > 0) {
      float_pressures_ = h.cast<float>();
      float_columns_.noalias() += float_P_.transpose() * float_pressures_;
    }
    answer_ = float_columns_.cast<double>();
  } else {
    answer_.noalias() = W_.transpose() * b;
    if (P_.rows() > 0) answer_.noalias() += P_.transpose() * h;
  }
  turned_S_ = S_;
  if (!turning.is_turned()) return;
  for (int i = 0; i < n_columns(); i += 3) {
    const Eigen::Matrix3d& left = turning.of_host(i / host_size);
    answer_.segment<3>(i) = (left * answer_.segment<3>(i)).eval();
    for (int j = 0; j < n_columns(); j += 3) {
      turned_S_.block<3, 3>(i, j) = left * S_.block<3, 3>(i, j) * turning.of_host(j / host_size).transpose();
    }
  }
}

void TiedResponses::add_to_bodies(Eigen::VectorXd& rows) const {
  for (int host = 0; host < ties_.n_hosts(); ++host) {
    rows.segment<host_size>(data_->hosts[static_cast<std::size_t>(host)].first) +=
        answer_.segment<host_size>(host_size * static_cast<Eigen::Index>(host));
  }
}

void TiedResponses::add_condensed(math::BlockMatrix& K) const {
  for (int a = 0; a < ties_.n_hosts(); ++a) {
    for (int b = 0; b < ties_.n_hosts(); ++b) {
      K.block(data_->hosts[static_cast<std::size_t>(a)].pattern_node,
              data_->hosts[static_cast<std::size_t>(b)].pattern_node) +=
          turned_S_.block<host_size, host_size>(host_size * static_cast<Eigen::Index>(a),
                                                host_size * static_cast<Eigen::Index>(b));
    }
  }
}

void TiedResponses::read_bodies(const Turning& turning, const Eigen::VectorXd& dq) {
  for (int host = 0; host < ties_.n_hosts(); ++host) {
    const Eigen::Index first = data_->hosts[static_cast<std::size_t>(host)].first;
    for (int i = 0; i < host_size; i += 3) {
      const Eigen::Vector3d part = dq.segment<3>(first + i);
      of_bodies_.segment<3>(host_size * static_cast<Eigen::Index>(host) + i) =
          turning.is_turned() ? Eigen::Vector3d(turning.of_host(host).transpose() * part) : part;
    }
  }
}

}  // namespace muldi::fem
