#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "base/error.hpp"
#include "math/sparse_cholesky.hpp"
#include "math/sparse_ldlt.hpp"
#include "math/sparse_lu.hpp"
#include "support/box_matrix.hpp"

namespace muldi::math {
namespace {

TEST(FullMatrix, HoldsBothTrianglesAndTakesNewValues) {
  test::BoxProblem problem;
  problem.cells = {2, 1, 3};
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  Eigen::SparseMatrix<double> full = full_matrix(matrix);
  EXPECT_EQ(Eigen::MatrixXd(full), matrix.dense());
  for (double& value : matrix.values()) value *= 3.0;
  refill(full, matrix);
  EXPECT_EQ(Eigen::MatrixXd(full), matrix.dense());
}

TEST(SparseLu, SolvesAnUnsymmetricMatrixAgainAfterNewValues) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Random(30, 30);
  SparseLu lu;
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(30, -1.0, 1.0);
  Eigen::VectorXd x(30);
  for (int repeat = 0; repeat < 3; ++repeat) {
    dense(repeat, 2 * repeat) += 5.0;
    const Eigen::SparseMatrix<double> matrix = dense.sparseView();
    ASSERT_EQ(lu.factorise(matrix), LuOutcome::ok);
    lu.solve(b, x);
    EXPECT_LT((dense * x - b).norm(), 1e-12);
    EXPECT_GT(lu.reciprocal_condition(), 0.0);
  }
}

TEST(SparseLu, SaysThatAMatrixIsSingular) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Identity(3, 3);
  dense(2, 2) = 0.0;
  SparseLu lu;
  EXPECT_EQ(lu.factorise(Eigen::SparseMatrix<double>(dense.sparseView(0.0, -1.0))), LuOutcome::singular);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(3);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(3);
  EXPECT_THROW(lu.solve(b, x), base::ContractError);
  EXPECT_EQ(lu.reciprocal_condition(), 0.0);
}

TEST(SparseLu, AgreesWithTheSymmetricFactorOnNearlyIncompressibleCells) {
  test::BoxProblem problem;
  problem.cells = {6, 5, 7};
  problem.bulk_modulus = 1000.0;
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  const NodeMask mask = test::box_mask(problem);
  SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  matrix.constrain(mask);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(pattern.n_rows(), 1.0, -2.0).array().sin();
  Eigen::VectorXd x(b.size());
  SparseLu lu;
  ASSERT_EQ(lu.factorise(full_matrix(matrix)), LuOutcome::ok);
  lu.solve(b, x);
  const LdltAnalysis analysis(pattern, mask);
  SparseLdlt ldlt(analysis);
  ASSERT_TRUE(ldlt.factorise(matrix).ok);
  Eigen::VectorXd y = b;
  ldlt.solve(y);
  EXPECT_LT((x - y).norm(), 1e-11 * y.norm()) << "condition number about 1e5";
}

TEST(SparseLu, KnowsTheSignOfTheDeterminant) {
  SparseLu lu;
  for (const double last : {-2.0, 2.0}) {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Identity(3, 3);
    dense(2, 2) = last;
    ASSERT_EQ(lu.factorise(Eigen::SparseMatrix<double>(dense.sparseView())), LuOutcome::ok);
    EXPECT_EQ(lu.determinant_sign(), last > 0.0 ? 1 : -1);
  }
}

TEST(SparseCholesky, AgreesWithOurFactorInSolutionAndInertia) {
  for (const double sign : {-1.0, 1.0}) {
    test::BoxProblem problem;
    problem.cells = {6, 5, 4};
    problem.bulk_modulus = 1000.0;
    problem.potential_sign = sign;
    const SymmetricBlockPattern pattern = test::box_pattern(problem);
    const NodeMask mask = test::box_mask(problem);
    SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
    matrix.constrain(mask, 1.0);
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(pattern.n_rows(), 1.0, -2.0).array().sin();
    const LdltAnalysis analysis(pattern, mask);
    SparseLdlt ldlt(analysis);
    const LdltOutcome outcome = ldlt.factorise(matrix);
    ASSERT_TRUE(outcome.ok);
    Eigen::VectorXd y = b;
    ldlt.solve(y);
    // Tried as a definite one first, which the quasi-definite matrix is not.
    for (const bool definite : {true, false}) {
      SparseCholesky cholesky;
      ASSERT_TRUE(cholesky.factorise(full_matrix(matrix), definite));
      EXPECT_EQ(cholesky.n_negative(), outcome.n_negative);
      Eigen::VectorXd x(b.size());
      cholesky.solve(b, x);
      EXPECT_LT((x - y).norm(), 1e-11 * y.norm()) << "condition number about 1e5";
    }
  }
}

TEST(SparseCholesky, SaysThatAMatrixIsSingular) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Identity(3, 3);
  dense(2, 2) = 0.0;
  SparseCholesky cholesky;
  EXPECT_FALSE(cholesky.factorise(Eigen::SparseMatrix<double>(dense.sparseView(0.0, -1.0)), true));
}

}  // namespace
}  // namespace muldi::math
