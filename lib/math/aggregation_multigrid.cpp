#include "math/aggregation_multigrid.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "math/vector_loops.hpp"

namespace muldi::math {
namespace {

using Index = std::size_t;

/// Entries this much smaller than the largest of their row say nothing about smooth functions.
constexpr double strength = 0.25;
constexpr int coarsest_size = 400;
constexpr int smoothing_degree = 2;
/// The smoothing acts on the upper part of the spectrum; the coarse grid does the rest.
constexpr double spectrum_part = 6.0;

Eigen::VectorXd diagonal_of(const DoubleCsr& a) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(a.n_rows);
  for (int i = 0; i < a.n_rows; ++i) {
    a.for_row(i, [&](int j, double value) { result(i) += i == j ? value : 0.0; });
    MULDI_EXPECT(result(i) > 0.0, "a positive diagonal");
  }
  return result;
}

/// The entries that smooth functions follow; the others are added to the diagonal.
DoubleCsr filtered(const DoubleCsr& a) {
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(a.n_rows);
  for (int i = 0; i < a.n_rows; ++i) {
    a.for_row(i, [&](int j, double value) {
      if (i != j) largest(i) = std::max(largest(i), -value);
    });
  }
  DoubleCsr result;
  result.n_rows = result.n_columns = a.n_rows;
  for (int i = 0; i < a.n_rows; ++i) {
    const Index diagonal = result.columns.size();
    result.columns.push_back(i);
    result.values.push_back(0.0);
    a.for_row(i, [&](int j, double value) {
      // Symmetric: strong for either of the two rows.
      if (i != j && -value > 0.0 && -value >= strength * std::min(largest(i), largest(j))) {
        result.columns.push_back(j);
        result.values.push_back(value);
      } else {
        result.values[diagonal] += value;
      }
    });
    result.start.push_back(static_cast<int>(result.columns.size()));
  }
  return result;
}

/// The aggregate of every row, -1 for rows without strong neighbours; the number of aggregates.
struct Aggregates {
  std::vector<int> of_row;
  int count = 0;
};

Aggregates aggregate(const DoubleCsr& strong) {
  Aggregates result{std::vector<int>(static_cast<Index>(strong.n_rows), -1), 0};
  std::vector<int>& of = result.of_row;
  for (int i = 0; i < strong.n_rows; ++i) {  // whole neighbourhoods
    bool is_free = of[static_cast<Index>(i)] < 0;
    int n_neighbours = 0;
    strong.for_row(i, [&](int j, double) {
      is_free = is_free && of[static_cast<Index>(j)] < 0;
      n_neighbours += i != j ? 1 : 0;
    });
    if (!is_free || n_neighbours == 0) continue;
    strong.for_row(i, [&](int j, double) { of[static_cast<Index>(j)] = result.count; });
    ++result.count;
  }
  std::vector<int> joined = of;  // the rest joins the neighbour that it follows most
  for (int i = 0; i < strong.n_rows; ++i) {
    if (of[static_cast<Index>(i)] >= 0) continue;
    double best = 0.0;
    strong.for_row(i, [&](int j, double value) {
      if (i == j || of[static_cast<Index>(j)] < 0 || -value <= best) return;
      best = -value;
      joined[static_cast<Index>(i)] = of[static_cast<Index>(j)];
    });
  }
  of = std::move(joined);
  for (int i = 0; i < strong.n_rows; ++i) {
    if (of[static_cast<Index>(i)] >= 0 ||
        strong.start[static_cast<Index>(i) + 1] - strong.start[static_cast<Index>(i)] < 2)
      continue;
    strong.for_row(i, [&](int j, double) {
      if (of[static_cast<Index>(j)] < 0) of[static_cast<Index>(j)] = result.count;
    });
    ++result.count;
  }
  return result;
}

/// Estimates the largest eigenvalue of D^-1 A by power iteration, and adds a margin.
double largest_eigenvalue(const DoubleCsr& a, const Eigen::VectorXd& diagonal) {
  Eigen::VectorXd x(a.n_rows);
  double bound = 0.0;  // no eigenvalue is above it (Gershgorin)
  for (int i = 0; i < a.n_rows; ++i) {
    // Constrained rows are solved exactly and may have any scale: they must not hide the others.
    x(i) = a.start[static_cast<Index>(i) + 1] - a.start[static_cast<Index>(i)] > 1 ? rough_entry(i) : 0.0;
    double sum = 0.0;
    a.for_row(i, [&](int, double value) { sum += std::abs(value); });
    bound = std::max(bound, sum / diagonal(i));
  }
  double eigenvalue = 1.0;
  Eigen::VectorXd y(a.n_rows);
  for (int step = 0; step < 15; ++step) {
    const double length = std::sqrt(x.dot(diagonal.cwiseProduct(x)));
    if (length == 0.0) break;
    x /= length;
    for_vector_chunks(a.n_rows, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
      for (std::ptrdiff_t i = first; i < first + n; ++i) y(i) = a.row_times(i, x.data());
    });
    eigenvalue = x.dot(y);
    x = y.cwiseQuotient(diagonal);
  }
  return std::min(1.1 * eigenvalue, bound);
}

/// (I - 4/3 / lambda D^-1 A) T, where T spreads the value of an aggregate to its rows.
DoubleCsr prolongation(const DoubleCsr& strong, const Aggregates& aggregates, double eigenvalue) {
  DoubleCsr tentative;
  tentative.n_rows = strong.n_rows;
  tentative.n_columns = aggregates.count;
  for (const int aggregate : aggregates.of_row) {
    if (aggregate >= 0) {
      tentative.columns.push_back(aggregate);
      tentative.values.push_back(1.0);
    }
    tentative.start.push_back(static_cast<int>(tentative.columns.size()));
  }
  DoubleCsr smoothing = strong;
  const Eigen::VectorXd diagonal = diagonal_of(strong);
  for (int i = 0; i < smoothing.n_rows; ++i) {
    for (int e = smoothing.start[static_cast<Index>(i)]; e < smoothing.start[static_cast<Index>(i) + 1]; ++e) {
      double& value = smoothing.values[static_cast<Index>(e)];
      value *= -4.0 / (3.0 * eigenvalue * diagonal(i));
      if (smoothing.columns[static_cast<Index>(e)] == i) value += 1.0;
    }
  }
  return product(smoothing, tentative);
}

}  // namespace

AggregationMultigrid::AggregationMultigrid(DoubleCsr matrix) {
  while (true) {
    const double eigenvalue = largest_eigenvalue(matrix, diagonal_of(matrix));
    add_level(matrix, eigenvalue);
    if (matrix.n_rows <= coarsest_size) break;
    const DoubleCsr strong = filtered(matrix);
    const Aggregates aggregates = aggregate(strong);
    // Nothing left but rows without neighbours: smoothing solves them.
    if (aggregates.count == 0 || aggregates.count > matrix.n_rows * 9 / 10) return;
    const DoubleCsr p = prolongation(strong, aggregates, eigenvalue);
    const DoubleCsr r = transposed(p);
    levels_.back().prolongation = in_single_precision(p);
    levels_.back().restriction = in_single_precision(r);
    matrix = product(r, product(matrix, p));
  }
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(matrix.n_rows, matrix.n_rows);
  for (int i = 0; i < matrix.n_rows; ++i) matrix.for_row(i, [&](int j, double value) { dense(i, j) += value; });
  coarsest_.compute(dense);
  MULDI_EXPECT(coarsest_.info() == Eigen::Success, "a positive definite matrix");
  coarsest_x_.resize(matrix.n_rows);
}

void AggregationMultigrid::add_level(const DoubleCsr& matrix, double eigenvalue) {
  Level level;
  level.matrix = in_single_precision(matrix);
  level.inverse_diagonal = diagonal_of(matrix).cwiseInverse().cast<float>();
  level.largest_eigenvalue = eigenvalue;
  for (Eigen::VectorXf* v : {&level.x, &level.b, &level.r, &level.d}) v->setZero(matrix.n_rows);
  levels_.push_back(std::move(level));
}

double AggregationMultigrid::operator_complexity() const {
  double entries = 0.0;
  for (const Level& level : levels_) entries += static_cast<double>(level.matrix.values.size());
  return entries / static_cast<double>(levels_.front().matrix.values.size());
}

void AggregationMultigrid::smooth(Level& level, const Eigen::VectorXf& b, Eigen::VectorXf& x, bool from_zero) {
  const double upper = level.largest_eigenvalue;
  const double middle = 0.5 * (upper + upper / spectrum_part);
  const double half = 0.5 * (upper - upper / spectrum_part);
  double rho = half / middle;
  // d = momentum d + gain D^-1 (b - A x); x += d
  double momentum = 0.0;
  double gain = 1.0 / middle;
  for (int step = 0; step < smoothing_degree; ++step) {
    const float m = static_cast<float>(momentum);
    const float g = static_cast<float>(gain);
    const bool zero = from_zero && step == 0;
    for_vector_chunks(x.size(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
      for (std::ptrdiff_t i = first; i < first + n; ++i) {
        const float r = zero ? b(i) : b(i) - level.matrix.row_times(i, x.data());
        level.d(i) = (step == 0 ? 0.0F : m * level.d(i)) + g * level.inverse_diagonal(i) * r;
      }
    });
    for_vector_chunks(x.size(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
      if (zero) {
        x.segment(first, n) = level.d.segment(first, n);
      } else {
        x.segment(first, n) += level.d.segment(first, n);
      }
    });
    const double next = 1.0 / (2.0 * middle / half - rho);
    momentum = next * rho;
    gain = 2.0 * next / half;
    rho = next;
  }
}

void AggregationMultigrid::cycle(std::size_t l, const Eigen::VectorXf& b, Eigen::VectorXf& x) {
  Level& level = levels_[l];
  if (l + 1 == levels_.size() && coarsest_x_.size() > 0) {
    coarsest_x_ = b.cast<double>();
    coarsest_.solveInPlace(coarsest_x_);
    x = coarsest_x_.cast<float>();
    return;
  }
  smooth(level, b, x, true);
  if (l + 1 < levels_.size()) {
    Level& coarse = levels_[l + 1];
    for_vector_chunks(x.size(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
      for (std::ptrdiff_t i = first; i < first + n; ++i) level.r(i) = b(i) - level.matrix.row_times(i, x.data());
    });
    for_vector_chunks(coarse.b.size(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
      for (std::ptrdiff_t i = first; i < first + n; ++i) coarse.b(i) = level.restriction.row_times(i, level.r.data());
    });
    cycle(l + 1, coarse.b, coarse.x);
    for_vector_chunks(x.size(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
      for (std::ptrdiff_t i = first; i < first + n; ++i) x(i) += level.prolongation.row_times(i, coarse.x.data());
    });
  }
  smooth(level, b, x, false);
  for_vector_chunks(x.size(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    for (std::ptrdiff_t i = first; i < first + n; ++i) {
      const Index row = static_cast<Index>(i);
      if (level.matrix.start[row + 1] - level.matrix.start[row] == 1) x(i) = b(i) * level.inverse_diagonal(i);
    }
  });
}

void AggregationMultigrid::apply(const Eigen::VectorXf& b, Eigen::VectorXf& x) {
  MULDI_EXPECT(b.size() == n_rows() && x.size() == n_rows() && &b != &x, "vectors of the matrix' size");
  cycle(0, b, x);
}

}  // namespace muldi::math
