#include "fem/solid/solid_linear.hpp"

#include <Eigen/Eigenvalues>

namespace muldi::fem {

SolidLinear::SolidLinear(const math::SymmetricBlockPattern& pattern, const math::NodeMask& mask,
                         std::vector<std::vector<int>> electrodes)
    : matrix_(pattern),
      mask_(mask),
      electrodes_(std::move(electrodes)),
      indicator_(Eigen::VectorXd::Zero(electrodes_.empty() ? 0 : matrix_.n_rows())) {
  const int block = pattern.block_size();
  for (std::size_t node = 0; node < mask.size(); ++node) {
    for (int i = 0; i < block; ++i) {
      if ((mask[node] >> i & 1) != 0) masked_.push_back(static_cast<Eigen::Index>(node) * block + i);
    }
  }
  const auto n = static_cast<Eigen::Index>(electrodes_.size());
  columns_ = Eigen::MatrixXd::Zero(matrix_.n_rows(), n);
  responses_ = columns_;
  schur_ = Eigen::MatrixXd::Zero(n, n);
  inverse_schur_ = schur_;
  common_ = Eigen::MatrixXd::Zero(n, 1);
}

double SolidLinear::sum_over(const std::vector<int>& nodes, const Eigen::VectorXd& x) const {
  double sum = 0.0;
  for (const int node : nodes) sum += x[static_cast<Eigen::Index>(node) * matrix_.block_size() + 3];
  return sum;
}

void SolidLinear::scale_potentials(double factor, Eigen::Ref<Eigen::MatrixXd> x) {
  for (Eigen::Index i = 3; i < x.rows(); i += 4) x.row(i) *= factor;
}

void SolidLinear::make_border() {
  for (std::size_t e = 0; e < electrodes_.size(); ++e) {
    const auto column = static_cast<Eigen::Index>(e);
    indicator_.setZero();
    for (const int node : electrodes_[e]) indicator_[static_cast<Eigen::Index>(node) * matrix_.block_size() + 3] = 1.0;
    matrix_.multiply(indicator_, columns_.col(column));
    for (std::size_t other = 0; other < electrodes_.size(); ++other) {
      schur_(static_cast<Eigen::Index>(other), column) = sum_over(electrodes_[other], columns_.col(column));
    }
  }
  for (const Eigen::Index i : masked_) columns_.row(i).setZero();
}

bool SolidLinear::factorise() {
  scale_ = prepare();
  make_border();
  n_negative_ = factorise_free();
  if (n_negative_ < 0) return false;
  if (electrodes_.empty()) return true;
  responses_ = columns_;
  solve_free_columns(responses_);
  for (const Eigen::Index i : masked_) responses_.row(i).setZero();
  schur_.noalias() -= columns_.transpose() * responses_;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(schur_);
  const Eigen::VectorXd& values = eigen.eigenvalues();
  n_negative_ += static_cast<int>((values.array() < 0.0).count());
  if (values.cwiseAbs().minCoeff() == 0.0) return false;
  inverse_schur_ = eigen.eigenvectors() * values.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
  return true;
}

void SolidLinear::add_border(Eigen::MatrixXd& common, Eigen::Ref<Eigen::MatrixXd> x) {
  common.noalias() -= columns_.transpose() * x;
  common = (inverse_schur_ * common).eval();
  x.noalias() -= responses_ * common;
  for (std::size_t e = 0; e < electrodes_.size(); ++e) {
    for (const int node : electrodes_[e]) {
      x.row(static_cast<Eigen::Index>(node) * matrix_.block_size() + 3) = common.row(static_cast<Eigen::Index>(e));
    }
  }
}

void SolidLinear::solve(Eigen::VectorXd& x) {
  if (scale_ != 1.0) scale_potentials(scale_, x);
  common_.resize(static_cast<Eigen::Index>(electrodes_.size()), 1);
  for (std::size_t e = 0; e < electrodes_.size(); ++e) {
    common_(static_cast<Eigen::Index>(e), 0) = sum_over(electrodes_[e], x);
  }
  for (const Eigen::Index i : masked_) x[i] = 0.0;
  solve_free(x);
  for (const Eigen::Index i : masked_) x[i] = 0.0;
  if (!electrodes_.empty()) add_border(common_, x);
  if (scale_ != 1.0) scale_potentials(scale_, x);
}

void SolidLinear::solve_columns(Eigen::MatrixXd& x) {
  if (scale_ != 1.0) scale_potentials(scale_, x);
  common_.resize(static_cast<Eigen::Index>(electrodes_.size()), x.cols());
  for (std::size_t e = 0; e < electrodes_.size(); ++e) {
    auto sums = common_.row(static_cast<Eigen::Index>(e));
    sums.setZero();
    for (const int node : electrodes_[e]) sums += x.row(static_cast<Eigen::Index>(node) * matrix_.block_size() + 3);
  }
  for (const Eigen::Index i : masked_) x.row(i).setZero();
  solve_free_columns(x);
  for (const Eigen::Index i : masked_) x.row(i).setZero();
  if (!electrodes_.empty()) add_border(common_, x);
  if (scale_ != 1.0) scale_potentials(scale_, x);
}

void SolidLinear::solve_free_columns(Eigen::MatrixXd& x) {
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    indicator_ = x.col(j);
    solve_free(indicator_);
    x.col(j) = indicator_;
  }
}

}  // namespace muldi::fem
