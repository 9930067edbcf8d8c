#include "math/block_chebyshev.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/error.hpp"
#include "math/vector_loops.hpp"

namespace muldi::math {
namespace {

using Index = std::size_t;
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 4, 4>;

constexpr int lanczos_steps = 10;
/// Degree over the square root of the ratio of the eigenvalues: measured with cubes of 32^3 and 64^3 cells.
constexpr double degree_of_spectrum = 1.25;

}  // namespace

BlockChebyshev::BlockChebyshev(const SymmetricBlockPattern& pattern, int block_size, Degrees degrees)
    : matrix_(pattern, block_size),
      degrees_(degrees),
      degree_(degrees.least),
      inverse_diagonal_(static_cast<Index>(pattern.n_nodes()) * static_cast<Index>(block_size * block_size)) {
  MULDI_EXPECT(degrees.least >= 1 && degrees.largest >= degrees.least, "at least one step");
  for (Eigen::VectorXf* v : {&x_, &r_, &d_, &q_}) v->setZero(matrix_.n_rows());
}

std::ptrdiff_t BlockChebyshev::bytes() const {
  return static_cast<std::ptrdiff_t>(sizeof(float)) *
         (static_cast<std::ptrdiff_t>(matrix_.values().size() + inverse_diagonal_.size()) + 4 * x_.size());
}

bool BlockChebyshev::update(const SymmetricBlockMatrix& matrix, bool new_spectrum) {
  matrix_.assign_leading(matrix);
  const SymmetricBlockPattern& pattern = matrix.pattern();
  const int b = matrix_.block_size();
  std::atomic<bool> definite{true};
  for_vector_chunks(pattern.n_nodes(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    for (std::ptrdiff_t i = first; i < first + n; ++i) {
      const std::ptrdiff_t slot = pattern.row_start()[static_cast<Index>(i)];
      const Eigen::Map<const SmallMatrix, 0, Eigen::OuterStride<>> block(
          matrix.values().data() + slot * matrix.block_size() * matrix.block_size(), b, b,
          Eigen::OuterStride<>(matrix.block_size()));
      const Eigen::LLT<SmallMatrix> factor(block);
      if (factor.info() != Eigen::Success) definite = false;
      Eigen::Map<Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          inverse_diagonal_.data() + i * b * b, b, b) = factor.solve(SmallMatrix::Identity(b, b)).cast<float>();
    }
  });
  if (!definite) return false;
  if (upper_ == 0.0 || new_spectrum) estimate_spectrum();
  return std::isfinite(upper_) && upper_ > 0.0;
}

void BlockChebyshev::times_inverse_diagonal(const Eigen::VectorXf& r, Eigen::VectorXf& out) const {
  const int b = matrix_.block_size();
  for_vector_chunks(matrix_.pattern().n_nodes(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    for (std::ptrdiff_t i = first; i < first + n; ++i) {
      const float* block = inverse_diagonal_.data() + i * b * b;
      for (int row = 0; row < b; ++row) {
        float sum = 0.0F;
        for (int c = 0; c < b; ++c) sum += block[row * b + c] * r(i * b + c);
        out(i * b + row) = sum;
      }
    }
  });
}

/// Conjugate gradients from a rough right-hand side; their coefficients make the Lanczos matrix of D^-1 A.
void BlockChebyshev::estimate_spectrum() {
  for (Eigen::Index i = 0; i < r_.size(); ++i) r_(i) = static_cast<float>(rough_entry(i));
  Eigen::VectorXd diagonal(lanczos_steps);
  Eigen::VectorXd off_diagonal(lanczos_steps);
  times_inverse_diagonal(r_, x_);
  d_ = x_;
  double rz = dot(r_, x_);
  double alpha_before = 1.0;
  double beta = 0.0;
  int k = 0;
  for (; k < lanczos_steps; ++k) {
    matrix_.multiply(d_, q_);
    const double curvature = dot(d_, q_);
    if (!(curvature > 0.0)) break;
    const double alpha = rz / curvature;
    diagonal(k) = 1.0 / alpha + beta / alpha_before;
    add_scaled(r_, static_cast<float>(-alpha), q_);
    times_inverse_diagonal(r_, x_);
    const double rz_new = dot(r_, x_);
    beta = rz_new / rz;
    if (!(beta > 1e-10)) {
      ++k;
      break;
    }
    off_diagonal(k) = std::sqrt(beta) / alpha;
    alpha_before = alpha;
    rz = rz_new;
    d_ = x_ + static_cast<float>(beta) * d_;
  }
  MULDI_EXPECT(k > 0, "a positive definite matrix");
  Eigen::MatrixXd lanczos = Eigen::MatrixXd::Zero(k, k);
  lanczos.diagonal() = diagonal.head(k);
  lanczos.diagonal(-1) = off_diagonal.head(k - 1);
  const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(lanczos).eigenvalues();
  upper_ = 1.1 * eigenvalues(k - 1);
  const double wanted = degree_of_spectrum * std::sqrt(upper_ / std::max(0.9 * eigenvalues(0), 1e-6 * upper_));
  degree_ = std::clamp(static_cast<int>(std::ceil(wanted)), degrees_.least, degrees_.largest);
  // Below: conjugate gradients do the rest better than a polynomial of low degree that reaches too far down.
  const double reach = 4.0 * degree_ * degree_;
  lower_ = std::max(0.9 * eigenvalues(0), upper_ / reach);
  lower_ = std::min(lower_, 0.9 * upper_);
}

/// r -= A d (not at first); d = momentum d + gain D^-1 r; x += d
template <int b>
void BlockChebyshev::step(float momentum, float gain, bool first) {
  using Node = Eigen::Matrix<float, b, 1>;
  using Block = Eigen::Matrix<float, b, b, b == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
  if (!first) matrix_.multiply(d_, q_);
  for_vector_chunks(matrix_.pattern().n_nodes(), [&](std::ptrdiff_t begin, std::ptrdiff_t n) {
    for (std::ptrdiff_t i = begin; i < begin + n; ++i) {
      Eigen::Map<Node> r(r_.data() + i * b);
      Eigen::Map<Node> d(d_.data() + i * b);
      Eigen::Map<Node> x(x_.data() + i * b);
      const Eigen::Map<const Block> inverse(inverse_diagonal_.data() + i * b * b);
      if (!first) r -= Eigen::Map<const Node>(q_.data() + i * b);
      const Node scaled = gain * (inverse * r);
      const Node next = first ? scaled : Node(momentum * d + scaled);
      d = next;
      if (first) {
        x = next;
      } else {
        x += next;
      }
    }
  });
}

void BlockChebyshev::apply(const Eigen::VectorXd& r, int stride, Eigen::VectorXd& z) {
  const int b = matrix_.block_size();
  const int n_nodes = matrix_.pattern().n_nodes();
  MULDI_EXPECT(stride >= b && r.size() == static_cast<Eigen::Index>(n_nodes) * stride && z.size() == r.size(),
               "vectors of the matrix' size");
  for_vector_chunks(n_nodes, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    for (std::ptrdiff_t i = first; i < first + n; ++i) {
      for (int c = 0; c < b; ++c) r_(i * b + c) = static_cast<float>(r(i * stride + c));
    }
  });
  const double middle = 0.5 * (upper_ + lower_);
  const double half = 0.5 * (upper_ - lower_);
  double rho = half / middle;
  double momentum = 0.0;
  double gain = 1.0 / middle;
  for (int k = 0; k < degree_; ++k) {
    const float m = static_cast<float>(momentum);
    const float g = static_cast<float>(gain);
    if (b == 1) step<1>(m, g, k == 0);
    if (b == 2) step<2>(m, g, k == 0);
    if (b == 3) step<3>(m, g, k == 0);
    if (b == 4) step<4>(m, g, k == 0);
    const double next = 1.0 / (2.0 * middle / half - rho);
    momentum = next * rho;
    gain = 2.0 * next / half;
    rho = next;
  }
  for_vector_chunks(n_nodes, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    for (std::ptrdiff_t i = first; i < first + n; ++i) {
      for (int c = 0; c < b; ++c) z(i * stride + c) = static_cast<double>(x_(i * b + c));
    }
  });
}

}  // namespace muldi::math
