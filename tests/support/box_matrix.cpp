#include "support/box_matrix.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace muldi::test {
namespace {

using Gradients = Eigen::Matrix<double, 8, 3>;
using CellMatrix = Eigen::Matrix<double, 32, 32>;

/// Corners of the unit cell in the order of box_cells.
constexpr int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

double shape(int a, const Eigen::Vector3d& x) {
  double value = 1.0;
  for (int d = 0; d < 3; ++d) value *= corner[a][d] == 1 ? x(d) : 1.0 - x(d);
  return value;
}

Gradients gradients(const Eigen::Vector3d& x) {
  Gradients result;
  for (int a = 0; a < 8; ++a) {
    for (int i = 0; i < 3; ++i) {
      result(a, i) = corner[a][i] == 1 ? 1.0 : -1.0;
      for (int d = 0; d < 3; ++d) {
        if (d != i) result(a, i) *= corner[a][d] == 1 ? x(d) : 1.0 - x(d);
      }
    }
  }
  return result;
}

void add_point(const BoxProblem& problem, const Eigen::Vector3d& x, CellMatrix& K) {
  const double weight = 1.0 / 8.0;
  const Gradients g = gradients(x);
  const Gradients middle = gradients(Eigen::Vector3d::Constant(0.5));
  for (int a = 0; a < 8; ++a) {
    for (int b = 0; b < 8; ++b) {
      const double dot = g.row(a).dot(g.row(b));
      for (int i = 0; i < 3; ++i) {
        K(4 * a + i, 4 * b + i) += weight * (dot + problem.mass * shape(a, x) * shape(b, x));
        for (int j = 0; j < 3; ++j) {
          K(4 * a + i, 4 * b + j) += weight * (g(a, j) * g(b, i) - 2.0 / 3.0 * g(a, i) * g(b, j) +
                                               problem.bulk_modulus * middle(a, i) * middle(b, j));
        }
        const double coupled = weight * problem.coupling * (g(a, i) * g(b, 2) + (i == 2 ? 0.5 * dot : 0.0));
        K(4 * a + i, 4 * b + 3) += coupled;
        K(4 * b + 3, 4 * a + i) += coupled;
      }
      K(4 * a + 3, 4 * b + 3) += weight * problem.potential_sign * problem.permittivity * dot;
    }
  }
}

CellMatrix cell_matrix(const BoxProblem& problem) {
  CellMatrix K = CellMatrix::Zero();
  const double offset = 0.5 / std::sqrt(3.0);
  for (const double z : {-offset, offset}) {
    for (const double y : {-offset, offset}) {
      for (const double x : {-offset, offset}) add_point(problem, {0.5 + x, 0.5 + y, 0.5 + z}, K);
    }
  }
  return K;
}

}  // namespace

int n_box_nodes(std::array<int, 3> cells) { return (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1); }

std::vector<std::array<int, 8>> box_cells(std::array<int, 3> cells) {
  std::vector<std::array<int, 8>> result;
  for (int k = 0; k < cells[2]; ++k) {
    for (int j = 0; j < cells[1]; ++j) {
      for (int i = 0; i < cells[0]; ++i) {
        std::array<int, 8> cell{};
        for (std::size_t a = 0; a < 8; ++a) {
          cell[a] = i + corner[a][0] + (cells[0] + 1) * (j + corner[a][1] + (cells[1] + 1) * (k + corner[a][2]));
        }
        result.push_back(cell);
      }
    }
  }
  return result;
}

math::SymmetricBlockPattern box_pattern(const BoxProblem& problem) {
  return {n_box_nodes(problem.cells), problem.block_size, box_cells(problem.cells)};
}

math::NodeMask box_mask(const BoxProblem& problem) {
  math::NodeMask mask(static_cast<std::size_t>(n_box_nodes(problem.cells)), 0);
  const std::size_t layer = static_cast<std::size_t>((problem.cells[0] + 1) * (problem.cells[1] + 1));
  const std::uint8_t all = static_cast<std::uint8_t>((1 << problem.block_size) - 1);
  for (std::size_t i = 0; i < layer; ++i) {
    if (problem.fixed_ends >= 1) mask[i] = all;
    if (problem.fixed_ends >= 2) mask[mask.size() - 1 - i] = all;
  }
  return mask;
}

math::SymmetricBlockMatrix box_matrix(const BoxProblem& problem, const math::SymmetricBlockPattern& pattern) {
  math::SymmetricBlockMatrix matrix(pattern);
  const CellMatrix K = cell_matrix(problem);
  const int size = problem.block_size;
  for (const math::CellSlots& slots : pattern.cell_slots()) {
    for (int a = 0; a < 8; ++a) {
      for (int b = a; b < 8; ++b) {
        const std::uint32_t slot = slots[static_cast<std::size_t>(math::cell_pair(a, b))];
        double* block = matrix.values().data() + static_cast<std::ptrdiff_t>(slot / 2) * size * size;
        for (int i = 0; i < size; ++i) {
          for (int j = 0; j < size; ++j) {
            block[size * i + j] += slot % 2 == 1 ? K(4 * a + j, 4 * b + i) : K(4 * a + i, 4 * b + j);
          }
        }
      }
    }
  }
  return matrix;
}

Eigen::SparseMatrix<double> free_part(const math::SymmetricBlockMatrix& matrix, const math::NodeMask& mask) {
  const math::SymmetricBlockPattern& pattern = matrix.pattern();
  const int b = matrix.block_size();
  std::vector<int> number(static_cast<std::size_t>(matrix.n_rows()), -1);
  int n = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    const std::size_t node = i / static_cast<std::size_t>(b);
    if (((mask[node] >> (i % static_cast<std::size_t>(b))) & 1) == 0) number[i] = n++;
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < pattern.n_nodes(); ++i) {
    for (int slot = pattern.row_start()[static_cast<std::size_t>(i)];
         slot < pattern.row_start()[static_cast<std::size_t>(i) + 1]; ++slot) {
      const int j = pattern.columns()[static_cast<std::size_t>(slot)];
      for (int e = 0; e < b * b; ++e) {
        const int row = number[static_cast<std::size_t>(i * b + e / b)];
        const int column = number[static_cast<std::size_t>(j * b + e % b)];
        if (row < 0 || column < 0) continue;
        const double value = matrix.values()[static_cast<std::size_t>(slot * b * b + e)];
        entries.emplace_back(row, column, value);
        if (i != j) entries.emplace_back(column, row, value);
      }
    }
  }
  Eigen::SparseMatrix<double> result(n, n);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace muldi::test
