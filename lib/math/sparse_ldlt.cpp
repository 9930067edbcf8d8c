#include "math/sparse_ldlt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "math/sparse_kernels.hpp"

namespace muldi::math {
namespace {

using Index = std::size_t;

/// Right-hand sides that pass through the factor together.
constexpr Eigen::Index group_size = 16;

/// A pivot below this part of its diagonal entry is zero: nothing but rounding is left of it.
constexpr double zero_ratio = 1e-14;

}  // namespace

SparseLdlt::SparseLdlt(const LdltAnalysis& analysis, FactorStorage storage) : analysis_(&analysis), storage_(storage) {}

void SparseLdlt::allocate() {
  const LdltAnalysis& a = *analysis_;
  const Index entries = static_cast<Index>(a.size().factor_entries);
  if (storage_ == FactorStorage::double_precision) {
    factor_.resize(entries);
  } else {
    float_factor_.resize(entries);
    panel_.resize(static_cast<Index>(a.largest_panel()));
  }
  signs_.resize(a.unknowns().size());
  diagonal_.resize(2 * static_cast<Index>(a.largest_stride()));
  constrained_diagonal_.resize(a.constrained().size());
  for (Index s = 0; s < 2; ++s) stacks_[s].resize(static_cast<Index>(a.stack_sizes()[s]));
  pack_.resize(static_cast<Index>(base::n_threads() * kernels::pack_size));
}

std::ptrdiff_t SparseLdlt::bytes() const {
  const std::size_t doubles = factor_.size() + signs_.size() + constrained_diagonal_.size() + stacks_[0].size() +
                              stacks_[1].size() + panel_.size() + diagonal_.size() + pack_.size() + work_.size();
  return static_cast<std::ptrdiff_t>(doubles * sizeof(double) +
                                     (float_factor_.size() + float_work_.size()) * sizeof(float));
}

void SparseLdlt::assemble(const Front& front, const double* values, double* panel) const {
  const int b = analysis_->block_size();
  const LdltAnalysis::Entry* entry = analysis_->entries().data() + front.entries[0];
  const LdltAnalysis::Entry* end = analysis_->entries().data() + front.entries[1];
  for (; entry != end; ++entry) {
    const double* block = values + static_cast<std::ptrdiff_t>(entry->slot) * b * b;
    const int row_step = entry->transposed ? 1 : b;
    const int column_step = entry->transposed ? b : 1;
    double* column = panel + static_cast<std::ptrdiff_t>(entry->column) * front.stride + entry->row;
    for (int c = 0; c < b; ++c) {
      if (((entry->column_mask >> c) & 1) != 0) continue;
      double* out = column;
      for (int r = 0; r < b; ++r) {
        if (((entry->row_mask >> r) & 1) != 0) continue;
        *out++ = block[r * row_step + c * column_step];
      }
      column += front.stride;
    }
  }
}

/// The part of the children's updates that falls into the pivot columns.
void SparseLdlt::add_to_panel(const Front& front, double* panel) const {
  for (int i = front.children[0]; i < front.children[1]; ++i) {
    const Front& child = analysis_->fronts()[static_cast<Index>(analysis_->children()[static_cast<Index>(i)])];
    const int shift = child.n_pivots / kernels::row_multiple * kernels::row_multiple;
    const double* update = stacks_[static_cast<Index>(child.stack)].data() + child.update_start - shift;
    const LdltAnalysis::Run* runs = analysis_->map_runs().data();
    for (int u = child.map[0]; u < child.map[1] && runs[u].to < front.n_pivots; ++u) {
      for (int c = 0; c < runs[u].length; ++c) {
        const double* source =
            update + static_cast<std::ptrdiff_t>(runs[u].from + c - child.n_pivots) * child.update_stride;
        double* target = panel + static_cast<std::ptrdiff_t>(runs[u].to + c) * front.stride;
        for (int v = u; v < child.map[1]; ++v) {
          const double* from = source + runs[v].from;
          double* to = target + runs[v].to;
          for (int r = v == u ? c : 0; r < runs[v].length; ++r) to[r] += from[r];
        }
      }
    }
  }
}

/// The other part, after the front's own update has been written.
void SparseLdlt::add_to_update(const Front& front, double* update) const {
  const int own_shift = front.n_pivots / kernels::row_multiple * kernels::row_multiple;
  for (int i = front.children[0]; i < front.children[1]; ++i) {
    const Front& child = analysis_->fronts()[static_cast<Index>(analysis_->children()[static_cast<Index>(i)])];
    const int shift = child.n_pivots / kernels::row_multiple * kernels::row_multiple;
    const double* child_update = stacks_[static_cast<Index>(child.stack)].data() + child.update_start - shift;
    const LdltAnalysis::Run* runs = analysis_->map_runs().data();
    for (int u = child.map[0]; u < child.map[1]; ++u) {
      if (runs[u].to < front.n_pivots) continue;
      for (int c = 0; c < runs[u].length; ++c) {
        const double* source =
            child_update + static_cast<std::ptrdiff_t>(runs[u].from + c - child.n_pivots) * child.update_stride;
        double* target =
            update + static_cast<std::ptrdiff_t>(runs[u].to + c - front.n_pivots) * front.update_stride - own_shift;
        for (int v = u; v < child.map[1]; ++v) {
          const double* from = source + runs[v].from;
          double* to = target + runs[v].to;
          for (int r = v == u ? c : 0; r < runs[v].length; ++r) to[r] += from[r];
        }
      }
    }
  }
}

bool SparseLdlt::eliminate(const Front& front, const double* values, LdltOutcome& outcome) {
  const std::ptrdiff_t stride = front.stride;
  const Index size = static_cast<Index>(stride * front.n_pivots);
  const bool keeps_double = storage_ == FactorStorage::double_precision;
  double* panel = keeps_double ? factor_.data() + front.factor_start : panel_.data();
  std::fill(panel, panel + size, 0.0);
  assemble(front, values, panel);
  double* diagonal = diagonal_.data();
  double* smallest = diagonal + analysis_->largest_stride();
  for (int j = 0; j < front.n_pivots; ++j) {
    diagonal[j] = std::abs(panel[j * stride + j]);
    smallest[j] = zero_ratio * diagonal[j];
  }
  add_to_panel(front, panel);
  const kernels::Panel work{panel,    stride,       front.n_rows,     front.n_pivots,     signs_.data() + front.first,
                            smallest, pack_.data(), base::run_chunks, base::thread_number};
  const int failed = kernels::table().factor_panel(work);
  if (failed >= 0) {
    outcome.zero_pivot = analysis_->unknowns()[static_cast<Index>(front.first + failed)];
    return false;
  }
  for (int j = 0; j < front.n_pivots; ++j) {
    const double pivot = panel[j * stride + j] * panel[j * stride + j];
    const double ratio = diagonal[j] > 0.0 ? pivot / diagonal[j] : std::numeric_limits<double>::infinity();
    outcome.smallest_ratio = std::min(outcome.smallest_ratio, ratio);
    outcome.largest_ratio = std::max(outcome.largest_ratio, ratio);
    if (work.signs[j] < 0.0) ++outcome.n_negative;
  }
  if (front.n_rows > front.n_pivots) {
    double* update = stacks_[static_cast<Index>(front.stack)].data() + front.update_start;
    kernels::table().schur_update(work, update, front.update_stride);
    add_to_update(front, update);
  }
  if (!keeps_double) {
    std::transform(panel, panel + size, float_factor_.data() + front.factor_start,
                   [](double value) { return static_cast<float>(value); });
  }
  return true;
}

LdltOutcome SparseLdlt::factorise(const SymmetricBlockMatrix& matrix) {
  MULDI_EXPECT(matrix.pattern().n_blocks() == analysis_->n_blocks() && matrix.n_rows() == analysis_->n_rows() &&
                   matrix.block_size() == analysis_->block_size(),
               "the matrix has the pattern of the analysis");
  allocate();
  factorised_ = false;
  LdltOutcome outcome;
  for (const Front& front : analysis_->fronts()) {
    if (!eliminate(front, matrix.values().data(), outcome)) return outcome;
  }
  const int b = matrix.block_size();
  for (Index i = 0; i < constrained_diagonal_.size(); ++i) {
    const int unknown = analysis_->constrained()[i];
    const int component = unknown % b;
    const std::ptrdiff_t slot = matrix.pattern().row_start()[static_cast<Index>(unknown / b)];
    const double own = matrix.values()[static_cast<Index>((slot * b + component) * b + component)];
    constrained_diagonal_[i] = own == 0.0 ? 1.0 : own;
  }
  outcome.ok = true;
  factorised_ = true;
  return outcome;
}

template <class Scalar>
void SparseLdlt::solve_group(const Scalar* factor, std::vector<Scalar>& work, Eigen::Ref<Eigen::MatrixXd>& x) {
  const std::vector<int>& unknowns = analysis_->unknowns();
  const Index n = unknowns.size();
  const Index sides = static_cast<Index>(x.cols());
  const Index stride = static_cast<Index>(analysis_->largest_stride());
  if (work.size() < (n + stride) * sides) work.resize((n + stride) * sides);
  Scalar* const y = work.data();
  Scalar* const w = y + n * sides;
  for (Index s = 0; s < sides; ++s) {
    const double* from = x.col(static_cast<Eigen::Index>(s)).data();
    for (Index i = 0; i < n; ++i) y[s * n + i] = static_cast<Scalar>(from[unknowns[i]]);
  }
  const auto copy_rows = [&](const Front& front, auto&& copy) {
    for (Index s = 0; s < sides; ++s) {
      copy(y + s * n + front.first, w + s * stride, front.n_pivots);
      for (int u = front.rows[0]; u < front.rows[1]; ++u) {
        const LdltAnalysis::Run& run = analysis_->row_runs()[static_cast<Index>(u)];
        copy(y + s * n + run.from, w + s * stride + run.to, run.length);
      }
    }
  };
  const auto gather = [](Scalar* all, Scalar* own, int length) { std::copy_n(all, length, own); };
  const auto scatter = [](Scalar* all, Scalar* own, int length) { std::copy_n(own, length, all); };
  const auto pass = [&](const Front& front, auto&& substitute) {
    copy_rows(front, gather);
    for (Index s = 0; s < sides; ++s)
      std::fill(w + s * stride + front.n_rows, w + s * stride + front.stride, Scalar(0));
    substitute(kernels::PanelSolve<Scalar>{factor + front.factor_start, front.stride, front.n_rows, front.n_pivots,
                                           signs_.data() + front.first, w, static_cast<std::ptrdiff_t>(stride),
                                           static_cast<int>(sides)});
  };
  const std::vector<Front>& fronts = analysis_->fronts();
  for (const Front& front : fronts) {
    pass(front, kernels::table().forward<Scalar>());
    copy_rows(front, scatter);
  }
  for (Index f = fronts.size(); f-- > 0;) {
    pass(fronts[f], kernels::table().backward<Scalar>());
    for (Index s = 0; s < sides; ++s)
      std::copy_n(w + s * stride, fronts[f].n_pivots, y + s * n + static_cast<Index>(fronts[f].first));
  }
  for (Index s = 0; s < sides; ++s) {
    double* to = x.col(static_cast<Eigen::Index>(s)).data();
    for (Index i = 0; i < n; ++i) to[unknowns[i]] = static_cast<double>(y[s * n + i]);
    for (Index i = 0; i < constrained_diagonal_.size(); ++i)
      to[analysis_->constrained()[i]] /= constrained_diagonal_[i];
  }
}

void SparseLdlt::solve(Eigen::Ref<Eigen::VectorXd> x) {
  solve_columns(Eigen::Map<Eigen::MatrixXd>(x.data(), x.size(), 1));
}

void SparseLdlt::solve_columns(Eigen::Ref<Eigen::MatrixXd> x) {
  MULDI_EXPECT(factorised_, "there is a factor");
  MULDI_EXPECT(x.rows() == analysis_->n_rows(), "right-hand sides of the matrix' size");
  for (Eigen::Index first = 0; first < x.cols(); first += group_size) {
    Eigen::Ref<Eigen::MatrixXd> group = x.middleCols(first, std::min(group_size, x.cols() - first));
    if (storage_ == FactorStorage::double_precision) {
      solve_group<double>(factor_.data(), work_, group);
    } else {
      solve_group<float>(float_factor_.data(), float_work_, group);
    }
  }
}

}  // namespace muldi::math
