#include "fem/solid/solid_linear.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "math/vector_loops.hpp"

namespace muldi::fem {

double balance_potentials(math::SymmetricBlockMatrix& matrix, const math::NodeMask& mask) {
  if (matrix.block_size() < 4) return 1.0;
  const auto row_start = matrix.pattern().row_start();
  double of_positions = 0.0, of_potentials = 0.0;
  long n_positions = 0, n_potentials = 0;
  for (std::size_t node = 0; node < mask.size(); ++node) {
    const double* block = matrix.values().data() + 16L * row_start[node];
    for (int i = 0; i < 4; ++i) {
      if ((mask[node] >> i & 1) != 0) continue;
      (i < 3 ? of_positions : of_potentials) += std::abs(block[5 * i]);
      ++(i < 3 ? n_positions : n_potentials);
    }
  }
  if (n_positions == 0 || n_potentials == 0 || of_potentials == 0.0 || of_positions == 0.0) return 1.0;
  const double ratio =
      of_positions / static_cast<double>(n_positions) * (static_cast<double>(n_potentials) / of_potentials);
  const double scale = std::exp2(std::round(0.5 * std::log2(ratio)));
  const auto values = matrix.values();
  math::for_vector_chunks(matrix.pattern().n_blocks(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    for (std::ptrdiff_t slot = first; slot < first + n; ++slot) {
      double* block = values.data() + 16 * slot;
      for (int i = 0; i < 3; ++i) {
        block[4 * i + 3] *= scale;
        block[12 + i] *= scale;
      }
      block[15] *= scale * scale;
    }
  });
  return scale;
}

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
  if (bonds_ != nullptr) bonds_->collect(matrix_.block_size(), x);
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
  if (bonds_ != nullptr) bonds_->follow(matrix_.block_size(), x);
}

void SolidLinear::solve_columns(Eigen::MatrixXd& x) {
  for (Eigen::Index j = 0; j < x.cols() && bonds_ != nullptr; ++j) bonds_->collect(matrix_.block_size(), x.col(j));
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
  for (Eigen::Index j = 0; j < x.cols() && bonds_ != nullptr; ++j) bonds_->follow(matrix_.block_size(), x.col(j));
}

void SolidLinear::solve_free_columns(Eigen::MatrixXd& x) {
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    indicator_ = x.col(j);
    solve_free(indicator_);
    x.col(j) = indicator_;
  }
}

}  // namespace muldi::fem
