#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "math/sparse_kernels.hpp"
#include "math/sparse_ldlt.hpp"
#include "support/box_matrix.hpp"

namespace muldi::math {
namespace {

constexpr Ordering orderings[] = {Ordering::natural, Ordering::minimum_degree, Ordering::nested_dissection,
                                  Ordering::automatic};

/// Diagonally dominant, so that it has a factor in every order; the sign of unknown i's diagonal is sign(i).
template <class Sign>
SymmetricBlockMatrix dominant_matrix(const SymmetricBlockPattern& pattern, Sign&& sign) {
  SymmetricBlockMatrix matrix(pattern);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> in(-1.0, 1.0);
  for (double& value : matrix.values()) value = in(random);
  const int b = pattern.block_size();
  std::vector<double> sums(static_cast<std::size_t>(pattern.n_rows()), 0.0);
  const auto entry = [&](int slot, int r, int c) -> double& {
    return matrix.values()[static_cast<std::size_t>((slot * b + r) * b + c)];
  };
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < pattern.n_nodes(); ++i) {
      const int diagonal = pattern.slot(i, i);
      for (int r = 0; r < b; ++r) {
        for (int c = 0; c < r; ++c) entry(diagonal, r, c) = entry(diagonal, c, r);
        const double sum = sums[static_cast<std::size_t>(i * b + r)];
        if (pass == 1) entry(diagonal, r, r) = sign(i * b + r) * (1.05 * sum + 0.1);
      }
      for (int s = pass == 0 ? diagonal : pattern.n_blocks(); s < pattern.row_start()[static_cast<std::size_t>(i) + 1];
           ++s) {
        const int j = pattern.columns()[static_cast<std::size_t>(s)];
        for (int r = 0; r < b; ++r) {
          for (int c = 0; c < b; ++c) {
            if (i != j || r != c) sums[static_cast<std::size_t>(i * b + r)] += std::abs(entry(s, r, c));
            if (i != j) sums[static_cast<std::size_t>(j * b + c)] += std::abs(entry(s, r, c));
          }
        }
      }
    }
  }
  return matrix;
}

SymmetricBlockPattern scattered_pattern(int n_nodes, int block_size, int n_pairs) {
  std::mt19937 random(static_cast<unsigned>(n_nodes));
  std::uniform_int_distribution<int> node(0, n_nodes - 1);
  std::vector<std::pair<int, int>> pairs;
  pairs.reserve(static_cast<std::size_t>(n_pairs));
  for (int i = 0; i < n_pairs; ++i) pairs.emplace_back(node(random), node(random));
  return {n_nodes, block_size, {}, pairs};
}

Eigen::VectorXd right_side(const SymmetricBlockPattern& pattern) {
  return Eigen::VectorXd::LinSpaced(pattern.n_rows(), 1.0, -2.0).array().sin();
}

class SparseLdltLevels : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { kernels::limit_level(GetParam()); }
  void TearDown() override { kernels::limit_level(4); }
};

TEST_P(SparseLdltLevels, SolvesLikeADenseSolverWithTheInertiaOfTheEigenvalues) {
  for (const int b : {1, 2, 3, 4}) {
    for (const int n : {1, 2, 5, 17, 40, 90}) {
      for (const int n_pairs : {0, n, 3 * n}) {
        const SymmetricBlockPattern pattern = scattered_pattern(n, b, n_pairs);
        for (const int kind : {0, 1, 2}) {  // definite, quasi-definite in every node, mixed
          const SymmetricBlockMatrix matrix = dominant_matrix(pattern, [&](int i) {
            const bool negative = kind == 1 ? i % b == b - 1 : kind == 2 && (i * i + i / 3) % 3 == 1;
            return negative ? -1.0 : 1.0;
          });
          const Eigen::MatrixXd dense = matrix.dense();
          const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues();
          const Eigen::VectorXd expected = dense.partialPivLu().solve(right_side(pattern));
          for (const Ordering ordering : orderings) {
            const LdltAnalysis analysis(pattern, {}, ordering);
            SparseLdlt factor(analysis);
            const LdltOutcome outcome = factor.factorise(matrix);
            ASSERT_TRUE(outcome.ok);
            EXPECT_EQ(outcome.n_negative, (eigenvalues.array() < 0.0).count());
            Eigen::VectorXd x = right_side(pattern);
            factor.solve(x);
            EXPECT_LT((x - expected).norm(), 1e-12 * expected.norm());
          }
        }
      }
    }
  }
}

TEST_P(SparseLdltLevels, SolvesElementMatricesInEveryOrder) {
  test::BoxProblem problem;
  problem.cells = {3, 4, 7};
  for (const double sign : {-1.0, 1.0}) {
    problem.potential_sign = sign;
    const SymmetricBlockPattern pattern = test::box_pattern(problem);
    const NodeMask mask = test::box_mask(problem);
    SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
    matrix.constrain(mask);
    const Eigen::VectorXd expected = matrix.dense().partialPivLu().solve(right_side(pattern));
    for (const Ordering ordering : orderings) {
      const LdltAnalysis analysis(pattern, mask, ordering);
      SparseLdlt factor(analysis);
      const LdltOutcome outcome = factor.factorise(matrix);
      ASSERT_TRUE(outcome.ok);
      EXPECT_EQ(outcome.n_negative, sign < 0.0 ? 7 * 20 : 0) << "one potential for each free node";
      Eigen::VectorXd x = right_side(pattern);
      factor.solve(x);
      EXPECT_LT((x - expected).norm(), 1e-12 * expected.norm());
    }
  }
}

TEST_P(SparseLdltLevels, SolvesManyColumnsLikeOneAfterTheOther) {
  test::BoxProblem problem;
  problem.cells = {4, 4, 4};
  problem.block_size = 3;
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  const LdltAnalysis analysis(pattern, test::box_mask(problem));
  const SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  for (const FactorStorage storage : {FactorStorage::double_precision, FactorStorage::single_precision}) {
    SparseLdlt factor(analysis, storage);
    ASSERT_TRUE(factor.factorise(matrix).ok);
    Eigen::MatrixXd x = Eigen::MatrixXd::Random(pattern.n_rows(), 23);
    Eigen::MatrixXd columns = x;
    factor.solve_columns(x);
    for (Eigen::Index c = 0; c < columns.cols(); ++c) {
      factor.solve(columns.col(c));
      // Groups of columns are summed in another order.
      const double tolerance = storage == FactorStorage::double_precision ? 1e-12 : 1e-4;
      EXPECT_LT((x.col(c) - columns.col(c)).norm(), tolerance * columns.col(c).norm());
    }
  }
}

TEST_P(SparseLdltLevels, HasTheSameBitsForAnyNumberOfThreads) {
  test::BoxProblem problem;
  problem.cells = {9, 9, 9};  // fronts of several chunks
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  const SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  for (const Ordering ordering : {Ordering::natural, Ordering::nested_dissection}) {
    const LdltAnalysis analysis(pattern, test::box_mask(problem), ordering);
    SparseLdlt factor(analysis);
    Eigen::VectorXd one;
    for (const int threads : {1, 2, 3}) {
      base::set_threads(threads);
      ASSERT_TRUE(factor.factorise(matrix).ok);
      Eigen::VectorXd x = right_side(pattern);
      factor.solve(x);
      if (threads == 1) one = x;
      EXPECT_EQ(x, one);
    }
    base::set_threads(1);
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, SparseLdltLevels, testing::Values(1, 3, 4));

TEST(SparseLdlt, SinglePrecisionStorageHalvesTheFactorAndConvergesInRefinement) {
  test::BoxProblem problem;
  problem.cells = {4, 4, 6};
  problem.bulk_modulus = 1000.0;
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  const NodeMask mask = test::box_mask(problem);
  SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  matrix.constrain(mask);
  const LdltAnalysis analysis(pattern, mask);
  SparseLdlt factor(analysis, FactorStorage::single_precision);
  SparseLdlt exact(analysis);
  ASSERT_TRUE(factor.factorise(matrix).ok);
  ASSERT_TRUE(exact.factorise(matrix).ok);
  EXPECT_LT(factor.bytes(), exact.bytes());
  const Eigen::VectorXd b = right_side(pattern);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
  Eigen::VectorXd r = b;
  for (int i = 0; i < 6; ++i) {
    factor.solve(r);
    x += r;
    Eigen::VectorXd product(b.size());
    matrix.multiply(x, product);
    r = b - product;
  }
  // Rounding of A x: 1e-16 times the stiffest row (about the bulk modulus) times x.
  EXPECT_LT(r.norm(), 1e-12 * x.norm());
}

TEST(SparseLdlt, LeavesConstrainedUnknownsOutOfTheFronts) {
  test::BoxProblem problem;
  problem.cells = {2, 2, 6};
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  NodeMask mask = test::box_mask(problem);
  for (std::size_t i = 0; i < mask.size(); i += 2) mask[i] |= 9;  // one displacement and the potential
  SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  const LdltAnalysis analysis(pattern, mask);
  const std::size_t n_free = 63 * 4 - analysis.constrained().size();
  EXPECT_EQ(analysis.size().n_unknowns, static_cast<std::ptrdiff_t>(n_free));
  SparseLdlt factor(analysis);
  ASSERT_TRUE(factor.factorise(matrix).ok) << "the matrix need not have been constrained";
  matrix.constrain(mask);
  Eigen::VectorXd x = right_side(pattern);
  factor.solve(x);
  const Eigen::VectorXd expected = matrix.dense().partialPivLu().solve(right_side(pattern));
  EXPECT_LT((x - expected).norm(), 1e-12 * expected.norm());
}

TEST(SparseLdlt, SolvesWhereEverythingIsConstrained) {
  const SymmetricBlockPattern pattern(3, 2, {});
  SymmetricBlockMatrix matrix(pattern);
  matrix.constrain({3, 3, 3}, 4.0);
  const LdltAnalysis analysis(pattern, {3, 3, 3});
  SparseLdlt factor(analysis);
  ASSERT_TRUE(factor.factorise(matrix).ok);
  Eigen::VectorXd x = Eigen::VectorXd::Ones(6);
  factor.solve(x);
  EXPECT_EQ(x, Eigen::VectorXd::Constant(6, 0.25));
}

TEST(SparseLdlt, NamesTheUnknownOfAZeroPivot) {
  const std::vector<std::pair<int, int>> pairs{{0, 1}};
  const SymmetricBlockPattern pattern(2, 1, {}, pairs);
  SymmetricBlockMatrix matrix(pattern);
  const LdltAnalysis analysis(pattern, {}, Ordering::natural);
  SparseLdlt factor(analysis);
  matrix.values()[0] = 4.0;
  matrix.values()[1] = 2.0;
  matrix.values()[2] = 1.0;  // 1 - 2 * 2 / 4 = 0
  const LdltOutcome singular = factor.factorise(matrix);
  EXPECT_FALSE(singular.ok);
  EXPECT_EQ(singular.zero_pivot, 1);
  Eigen::VectorXd x = Eigen::VectorXd::Ones(2);
  EXPECT_THROW(factor.solve(x), base::ContractError);
  matrix.values()[2] = std::nan("");
  EXPECT_EQ(factor.factorise(matrix).zero_pivot, 1) << "no number is no pivot";
  matrix.values()[2] = 0.5;  // indefinite: pivots 4 and -1/2
  const LdltOutcome indefinite = factor.factorise(matrix);
  EXPECT_TRUE(indefinite.ok);
  EXPECT_EQ(indefinite.n_negative, 1);
  EXPECT_DOUBLE_EQ(indefinite.smallest_ratio, 1.0);
  EXPECT_DOUBLE_EQ(indefinite.largest_ratio, 1.0);
}

TEST(SparseLdlt, ReportsTheCancellationOfAFloatingBody) {
  test::BoxProblem problem;
  problem.cells = {3, 3, 3};
  problem.block_size = 3;
  problem.fixed_ends = 0;  // six rigid motions
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  const LdltAnalysis analysis(pattern);
  SparseLdlt factor(analysis);
  const LdltOutcome outcome = factor.factorise(test::box_matrix(problem, pattern));
  EXPECT_TRUE(!outcome.ok || outcome.smallest_ratio < 1e-12);
}

TEST(SparseLdlt, ReportsPivotRatiosThatDoNotDependOnUnits) {
  test::BoxProblem problem;
  problem.cells = {2, 3, 4};
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  const LdltAnalysis analysis(pattern, test::box_mask(problem), Ordering::natural);
  SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  SparseLdlt factor(analysis);
  const LdltOutcome before = factor.factorise(matrix);
  for (std::size_t i = 0; i < matrix.values().size(); ++i) {
    const std::size_t entry = i % 16;
    matrix.values()[i] *= (entry % 4 == 3 ? 0x1p-20 : 1.0) * (entry / 4 == 3 ? 0x1p-20 : 1.0);
  }
  const LdltOutcome after = factor.factorise(matrix);
  EXPECT_DOUBLE_EQ(before.smallest_ratio, after.smallest_ratio);
  EXPECT_DOUBLE_EQ(before.largest_ratio, after.largest_ratio);
  EXPECT_EQ(before.n_negative, after.n_negative);
}

TEST(LdltAnalysis, KnowsTheMemoryBeforehand) {
  test::BoxProblem problem;
  problem.cells = {5, 5, 5};
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  const LdltAnalysis analysis(pattern, test::box_mask(problem));
  SparseLdlt factor(analysis);
  ASSERT_TRUE(factor.factorise(test::box_matrix(problem, pattern)).ok);
  const double estimated = static_cast<double>(analysis.size().factor_bytes + analysis.size().work_bytes);
  EXPECT_NEAR(static_cast<double>(factor.bytes()), estimated, 0.05 * estimated);
}

TEST(LdltAnalysis, KeepsLayersOfASlenderMeshInTheirOrder) {
  test::BoxProblem problem;
  problem.cells = {4, 4, 18};
  problem.fixed_ends = 2;
  const LdltAnalysis analysis(test::box_pattern(problem), test::box_mask(problem));
  EXPECT_EQ(analysis.size().ordering, Ordering::natural);
  EXPECT_EQ(analysis.size().n_unknowns, 1700);
  problem.cells = {8, 8, 8};
  const LdltAnalysis cube(test::box_pattern(problem), test::box_mask(problem));
  EXPECT_EQ(cube.size().ordering, Ordering::nested_dissection);
}

}  // namespace
}  // namespace muldi::math
