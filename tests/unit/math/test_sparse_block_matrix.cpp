#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "math/sparse_block_matrix.hpp"
#include "math/sparse_block_pattern.hpp"
#include "math/sparse_kernels.hpp"
#include "support/box_matrix.hpp"

namespace muldi::math {
namespace {

/// A matrix over scattered node pairs with values in [-1, 1], diagonal blocks symmetric.
SymmetricBlockMatrix random_matrix(const SymmetricBlockPattern& pattern) {
  SymmetricBlockMatrix matrix(pattern);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> in(-1.0, 1.0);
  for (double& value : matrix.values()) value = in(random);
  const int b = pattern.block_size();
  for (int i = 0; i < pattern.n_nodes(); ++i) {
    double* block = matrix.values().data() + static_cast<std::ptrdiff_t>(pattern.slot(i, i)) * b * b;
    for (int r = 0; r < b; ++r)
      for (int c = 0; c < r; ++c) block[r * b + c] = block[c * b + r];
  }
  return matrix;
}

std::vector<std::pair<int, int>> scattered_pairs(int n) {
  std::vector<std::pair<int, int>> pairs;
  pairs.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) pairs.emplace_back((7 * i + 3) % n, (5 * i * i + 1) % n);
  return pairs;
}

TEST(CellPair, CountsTheUpperTriangle) {
  int expected = 0;
  for (int a = 0; a < 8; ++a)
    for (int b = a; b < 8; ++b) EXPECT_EQ(cell_pair(a, b), expected++);
}

TEST(SymmetricBlockPattern, StoresUpperNeighboursAscending) {
  const std::vector<std::pair<int, int>> pairs{{3, 1}, {0, 3}, {1, 3}, {2, 2}};
  const SymmetricBlockPattern pattern(4, 3, {}, pairs);
  EXPECT_EQ(pattern.n_blocks(), 6);
  EXPECT_EQ(pattern.slot(0, 0), 0);
  EXPECT_EQ(pattern.slot(0, 3), 1);
  EXPECT_EQ(pattern.slot(1, 3), 3);
  EXPECT_EQ(pattern.slot(0, 1), -1);
  EXPECT_THROW(static_cast<void>(pattern.slot(3, 0)), base::ContractError);
}

TEST(SymmetricBlockPattern, FindsTheSlotsOfCellsInAnyNumbering) {
  const std::vector<std::array<int, 8>> cells{{9, 0, 3, 7, 1, 8, 2, 5}, {5, 4, 6, 9, 10, 0, 11, 2}};
  const SymmetricBlockPattern pattern(12, 4, cells);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (int a = 0; a < 8; ++a) {
      for (int b = a; b < 8; ++b) {
        const int i = cells[c][static_cast<std::size_t>(a)];
        const int j = cells[c][static_cast<std::size_t>(b)];
        const std::uint32_t slot = pattern.cell_slots()[c][static_cast<std::size_t>(cell_pair(a, b))];
        EXPECT_EQ(static_cast<int>(slot / 2), pattern.slot(std::min(i, j), std::max(i, j)));
        EXPECT_EQ(slot % 2 == 1, i > j);
      }
    }
  }
}

TEST(SymmetricBlockPattern, RefusesCellsThatRepeatANodeOrLeaveTheMesh) {
  const std::vector<std::array<int, 8>> repeated{{0, 1, 2, 3, 4, 5, 6, 6}};
  EXPECT_THROW(SymmetricBlockPattern(8, 3, repeated), base::ContractError);
  const std::vector<std::array<int, 8>> outside{{0, 1, 2, 3, 4, 5, 6, 8}};
  EXPECT_THROW(SymmetricBlockPattern(8, 3, outside), base::ContractError);
}

/// Block size, level of the kernels.
class SymmetricProduct : public testing::TestWithParam<std::tuple<int, int>> {
 protected:
  void SetUp() override { kernels::limit_level(std::get<1>(GetParam())); }
  void TearDown() override {
    kernels::limit_level(4);
    base::set_threads(1);
  }
};

TEST_P(SymmetricProduct, IsThatOfTheDenseMatrix) {
  const SymmetricBlockPattern pattern(60, std::get<0>(GetParam()), {}, scattered_pairs(60));
  const SymmetricBlockMatrix matrix = random_matrix(pattern);
  FloatBlockMatrix single(pattern);
  single.assign_leading(matrix);
  const Eigen::MatrixXd dense = matrix.dense();
  EXPECT_EQ((dense - dense.transpose()).norm(), 0.0);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(pattern.n_rows(), -1.0, 2.0);
  Eigen::VectorXd y = Eigen::VectorXd::Constant(pattern.n_rows(), 7.0);  // is overwritten
  matrix.multiply(x, y);
  EXPECT_LT((y - dense * x).lpNorm<Eigen::Infinity>(), 1e-13);
  Eigen::VectorXf z(pattern.n_rows());
  single.multiply(x.cast<float>(), z);
  EXPECT_LT((z.cast<double>() - dense * x).lpNorm<Eigen::Infinity>(), 1e-5);
}

TEST_P(SymmetricProduct, HasTheSameBitsForAnyNumberOfThreads) {
  test::BoxProblem problem;
  problem.cells = {15, 15, 15};  // four chunks
  problem.block_size = std::max(3, std::get<0>(GetParam()));
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  const SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  const Eigen::VectorXd x = Eigen::VectorXd::Random(pattern.n_rows());
  Eigen::VectorXd one(pattern.n_rows());
  matrix.multiply(x, one);
  const Eigen::SparseMatrix<double> all =
      test::free_part(matrix, NodeMask(static_cast<std::size_t>(pattern.n_nodes()), 0));
  EXPECT_LT((one - all * x).lpNorm<Eigen::Infinity>(), 1e-12);
  for (const int threads : {2, 3}) {
    base::set_threads(threads);
    Eigen::VectorXd more(pattern.n_rows());
    matrix.multiply(x, more);
    EXPECT_EQ(more, one);
  }
}

INSTANTIATE_TEST_SUITE_P(BlocksAndLevels, SymmetricProduct,
                         testing::Combine(testing::Values(1, 2, 3, 4), testing::Values(1, 3, 4)));

TEST(SymmetricBlockMatrix, ConstrainsRowsAndColumns) {
  const SymmetricBlockPattern pattern(5, 3, {}, scattered_pairs(5));
  const SymmetricBlockMatrix matrix = random_matrix(pattern);
  const NodeMask mask{0, 5, 0, 7, 2};
  SymmetricBlockMatrix own = matrix;
  own.constrain(mask);
  SymmetricBlockMatrix given = matrix;
  given.constrain(mask, -3.0);
  Eigen::MatrixXd expected = matrix.dense();
  Eigen::MatrixXd expected_given = expected;
  for (int i = 0; i < 15; ++i) {
    if (((mask[static_cast<std::size_t>(i / 3)] >> (i % 3)) & 1) == 0) continue;
    const double diagonal = expected(i, i);
    for (Eigen::MatrixXd* m : {&expected, &expected_given}) {
      m->row(i).setZero();
      m->col(i).setZero();
    }
    expected(i, i) = diagonal;
    expected_given(i, i) = -3.0;
  }
  EXPECT_EQ(own.dense(), expected);
  EXPECT_EQ(given.dense(), expected_given);
}

TEST(SymmetricBlockMatrix, ConstrainsAnUnknownWithoutDiagonalToOne) {
  const SymmetricBlockPattern pattern(2, 1, {});
  SymmetricBlockMatrix matrix(pattern);
  matrix.constrain({0, 1});
  EXPECT_EQ(matrix.dense(), (Eigen::MatrixXd{{0.0, 0.0}, {0.0, 1.0}}));
}

TEST(FloatBlockMatrix, TakesTheDisplacementsOfACoupledMatrix) {
  const SymmetricBlockPattern pattern(20, 4, {}, scattered_pairs(20));
  const SymmetricBlockMatrix matrix = random_matrix(pattern);
  FloatBlockMatrix displacement(pattern, 3);
  displacement.assign_leading(matrix);
  const Eigen::MatrixXf all = matrix.dense().cast<float>();
  const Eigen::MatrixXf part = displacement.dense();
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j) EXPECT_EQ(part(i, j), all(i / 3 * 4 + i % 3, j / 3 * 4 + j % 3));
  Eigen::VectorXf diagonal(60);
  displacement.diagonal(diagonal);
  EXPECT_EQ(diagonal, part.diagonal());
}

}  // namespace
}  // namespace muldi::math
