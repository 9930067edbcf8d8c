#include "math/sparse_block_matrix.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "math/sparse_kernels.hpp"

namespace muldi::math {
namespace {

/// Vector loads may run this many values over the end.
constexpr std::size_t overrun = 16;

/// Chunks large enough to repay their strip, few enough that the strips stay small.
int n_chunks(int n_nodes) { return std::clamp(n_nodes / 1024, 1, 16); }

}  // namespace

template <class Scalar>
BasicBlockMatrix<Scalar>::BasicBlockMatrix(const SymmetricBlockPattern& pattern, std::optional<int> block_size)
    : pattern_(&pattern),
      block_size_(block_size.value_or(pattern.block_size())),
      n_values_(static_cast<std::size_t>(pattern.n_blocks()) * static_cast<std::size_t>(block_size_ * block_size_)),
      values_(n_values_ + overrun, Scalar(0)) {
  MULDI_EXPECT(block_size_ >= 1 && block_size_ <= 4, "one to four unknowns a node");
  const int count = n_chunks(pattern.n_nodes());
  std::ptrdiff_t strip = 0;
  for (int c = 0; c < count; ++c) {
    const base::ChunkRange rows = base::chunk_range(pattern.n_nodes(), count, c);
    Chunk chunk{static_cast<int>(rows.first), static_cast<int>(rows.last), static_cast<int>(rows.last), strip};
    for (std::ptrdiff_t i = rows.first; i < rows.last; ++i) {
      const int last_slot = pattern.row_start()[static_cast<std::size_t>(i) + 1] - 1;
      chunk.last_column = std::max(chunk.last_column, pattern.columns()[static_cast<std::size_t>(last_slot)] + 1);
    }
    chunks_.push_back(chunk);
    strip += static_cast<std::ptrdiff_t>(chunk.last_column - chunk.first_row) * block_size_;
  }
  strips_.resize(static_cast<std::size_t>(strip) + overrun);
}

template <class Scalar>
void BasicBlockMatrix<Scalar>::set_zero() {
  base::parallel_for(static_cast<int>(chunks_.size()), [&](int c) {
    const base::ChunkRange range =
        base::chunk_range(static_cast<std::ptrdiff_t>(n_values_), static_cast<int>(chunks_.size()), c);
    std::fill(values_.begin() + range.first, values_.begin() + range.last, Scalar(0));
  });
}

template <class Scalar>
void BasicBlockMatrix<Scalar>::multiply(const Eigen::Ref<const Vector>& x, Eigen::Ref<Vector> y) const {
  MULDI_EXPECT(x.size() == n_rows() && y.size() == n_rows() && x.data() != y.data(), "vectors of the matrix' size");
  const auto product = kernels::table().block_product<Scalar>(block_size_);
  const int count = static_cast<int>(chunks_.size());
  base::parallel_for(count, [&](int c) {
    const Chunk& chunk = chunks_[static_cast<std::size_t>(c)];
    Scalar* strip = strips_.data() + chunk.strip;
    std::fill(strip, strip + static_cast<std::ptrdiff_t>(chunk.last_column - chunk.first_row) * block_size_, Scalar(0));
    product({pattern_->row_start().data(), pattern_->columns().data(), values_.data(), x.data(), strip, chunk.first_row,
             chunk.last_row});
  });
  base::parallel_for(count, [&](int c) { add_strips(static_cast<std::size_t>(c), y.data()); });
}

template <class Scalar>
void BasicBlockMatrix<Scalar>::add_strips(std::size_t chunk, Scalar* y) const {
  const Chunk& own = chunks_[chunk];
  const Scalar* own_strip = strips_.data() + own.strip;
  std::copy(own_strip, own_strip + static_cast<std::ptrdiff_t>(own.last_row - own.first_row) * block_size_,
            y + static_cast<std::ptrdiff_t>(own.first_row) * block_size_);
  for (std::size_t c = 0; c < chunk; ++c) {
    const Chunk& other = chunks_[c];
    const Scalar* strip = strips_.data() + other.strip;
    const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(own.first_row) * block_size_;
    const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(std::min(own.last_row, other.last_column)) * block_size_;
    const std::ptrdiff_t shift = static_cast<std::ptrdiff_t>(other.first_row) * block_size_;
    for (std::ptrdiff_t i = from; i < to; ++i) y[i] += strip[i - shift];
  }
}

template <class Scalar>
void BasicBlockMatrix<Scalar>::diagonal(Eigen::Ref<Vector> out) const {
  MULDI_EXPECT(out.size() == n_rows(), "a vector of the matrix' size");
  const std::ptrdiff_t b = block_size_;
  for (std::ptrdiff_t i = 0; i < pattern_->n_nodes(); ++i) {
    const std::ptrdiff_t slot = pattern_->row_start()[static_cast<std::size_t>(i)];
    for (std::ptrdiff_t r = 0; r < b; ++r) out(i * b + r) = values_[static_cast<std::size_t>((slot * b + r) * b + r)];
  }
}

template <class Scalar>
void BasicBlockMatrix<Scalar>::constrain(const NodeMask& mask, std::optional<double> diagonal_value) {
  MULDI_EXPECT(mask.size() == static_cast<std::size_t>(pattern_->n_nodes()), "one byte a node");
  const int b = block_size_;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    for (int slot = pattern_->row_start()[i]; slot < pattern_->row_start()[i + 1]; ++slot) {
      const std::size_t j = static_cast<std::size_t>(pattern_->columns()[static_cast<std::size_t>(slot)]);
      if ((mask[i] | mask[j]) == 0) continue;
      Scalar* block = values_.data() + static_cast<std::ptrdiff_t>(slot) * b * b;
      for (int r = 0; r < b; ++r) {
        for (int c = 0; c < b; ++c) {
          const bool constrained = ((mask[i] >> r) & 1) != 0 || ((mask[j] >> c) & 1) != 0;
          if (!constrained) continue;
          Scalar& entry = block[r * b + c];
          const Scalar own = entry == Scalar(0) ? Scalar(1) : entry;
          entry = i == j && r == c ? (diagonal_value ? static_cast<Scalar>(*diagonal_value) : own) : Scalar(0);
        }
      }
    }
  }
}

template <class Scalar>
void BasicBlockMatrix<Scalar>::assign_leading(const BasicBlockMatrix<double>& from) {
  MULDI_EXPECT(&from.pattern() == pattern_ && from.block_size() >= block_size_, "a matrix over the same pattern");
  const int b = block_size_;
  const int b_from = from.block_size();
  const double* source = from.values().data();
  const int count = static_cast<int>(chunks_.size());
  base::parallel_for(count, [&](int c) {
    const base::ChunkRange slots = base::chunk_range(pattern_->n_blocks(), count, c);
    for (std::ptrdiff_t slot = slots.first; slot < slots.last; ++slot) {
      for (int r = 0; r < b; ++r) {
        for (int k = 0; k < b; ++k) {
          values_[static_cast<std::size_t>((slot * b + r) * b + k)] =
              static_cast<Scalar>(source[(slot * b_from + r) * b_from + k]);
        }
      }
    }
  });
}

template <class Scalar>
Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> BasicBlockMatrix<Scalar>::dense() const {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using Block = Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  Matrix result = Matrix::Zero(n_rows(), n_rows());
  const std::ptrdiff_t b = block_size_;
  for (std::ptrdiff_t i = 0; i < pattern_->n_nodes(); ++i) {
    for (int slot = pattern_->row_start()[static_cast<std::size_t>(i)];
         slot < pattern_->row_start()[static_cast<std::size_t>(i) + 1]; ++slot) {
      const std::ptrdiff_t j = pattern_->columns()[static_cast<std::size_t>(slot)];
      const Block block(values_.data() + slot * b * b, b, b);
      result.block(i * b, j * b, b, b) = block;
      result.block(j * b, i * b, b, b) = block.transpose();
    }
  }
  return result;
}

template class BasicBlockMatrix<double>;
template class BasicBlockMatrix<float>;

}  // namespace muldi::math
