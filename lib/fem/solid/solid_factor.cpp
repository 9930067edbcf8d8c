#include "fem/solid/solid_factor.hpp"

#include <Eigen/Eigenvalues>

#include "base/memory.hpp"
#include "base/text.hpp"

namespace muldi::fem {
namespace {

/// Refuses a factor that the machine cannot hold, before anything of it is allocated.
const math::LdltAnalysis& affordable(const math::LdltAnalysis& analysis) {
  const math::LdltSize& size = analysis.size();
  base::require_memory(static_cast<double>(size.factor_bytes + size.work_bytes),
                       base::format("the factorised matrix of a solid with {} unknowns", size.n_unknowns),
                       "take fewer cells");
  return analysis;
}

}  // namespace

SolidFactor::SolidFactor(const math::SymmetricBlockPattern& pattern, const math::NodeMask& mask,
                         std::vector<std::vector<int>> electrodes, math::FactorStorage storage)
    : matrix_(pattern),
      analysis_(pattern, mask),
      factor_(affordable(analysis_), storage),
      electrodes_(std::move(electrodes)),
      indicator_(Eigen::VectorXd::Zero(matrix_.n_rows())) {
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
  common_ = Eigen::VectorXd::Zero(n);
}

double SolidFactor::sum_over(const std::vector<int>& nodes, const Eigen::VectorXd& x) const {
  double sum = 0.0;
  for (const int node : nodes) sum += x[static_cast<Eigen::Index>(node) * matrix_.block_size() + 3];
  return sum;
}

void SolidFactor::make_border() {
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

bool SolidFactor::factorise() {
  make_border();
  const math::LdltOutcome outcome = factor_.factorise(matrix_);
  n_negative_ = outcome.n_negative;
  if (!outcome.ok || outcome.smallest_ratio < singular_pivot) return false;
  if (electrodes_.empty()) return true;
  responses_ = columns_;
  factor_.solve_columns(responses_);
  for (const Eigen::Index i : masked_) responses_.row(i).setZero();
  schur_.noalias() -= columns_.transpose() * responses_;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(schur_);
  const Eigen::VectorXd& values = eigen.eigenvalues();
  n_negative_ += static_cast<int>((values.array() < 0.0).count());
  if (values.cwiseAbs().minCoeff() == 0.0) return false;
  inverse_schur_ = eigen.eigenvectors() * values.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
  return true;
}

void SolidFactor::solve(Eigen::VectorXd& x) {
  for (std::size_t e = 0; e < electrodes_.size(); ++e) {
    common_[static_cast<Eigen::Index>(e)] = sum_over(electrodes_[e], x);
  }
  for (const Eigen::Index i : masked_) x[i] = 0.0;
  factor_.solve(x);
  for (const Eigen::Index i : masked_) x[i] = 0.0;
  if (electrodes_.empty()) return;
  common_ -= columns_.transpose() * x;
  common_ = (inverse_schur_ * common_).eval();
  x.noalias() -= responses_ * common_;
  for (std::size_t e = 0; e < electrodes_.size(); ++e) {
    for (const int node : electrodes_[e]) {
      x[static_cast<Eigen::Index>(node) * matrix_.block_size() + 3] = common_[static_cast<Eigen::Index>(e)];
    }
  }
}

void SolidFactor::solve_columns(Eigen::MatrixXd& x) {
  const auto n = static_cast<Eigen::Index>(electrodes_.size());
  commons_.resize(n, x.cols());
  for (Eigen::Index e = 0; e < n; ++e) {
    commons_.row(e).setZero();
    for (const int node : electrodes_[static_cast<std::size_t>(e)]) {
      commons_.row(e) += x.row(static_cast<Eigen::Index>(node) * matrix_.block_size() + 3);
    }
  }
  for (const Eigen::Index i : masked_) x.row(i).setZero();
  factor_.solve_columns(x);
  for (const Eigen::Index i : masked_) x.row(i).setZero();
  if (electrodes_.empty()) return;
  commons_.noalias() -= columns_.transpose() * x;
  commons_ = (inverse_schur_ * commons_).eval();
  x.noalias() -= responses_ * commons_;
  for (Eigen::Index e = 0; e < n; ++e) {
    for (const int node : electrodes_[static_cast<std::size_t>(e)]) {
      x.row(static_cast<Eigen::Index>(node) * matrix_.block_size() + 3) = commons_.row(e);
    }
  }
}

}  // namespace muldi::fem
