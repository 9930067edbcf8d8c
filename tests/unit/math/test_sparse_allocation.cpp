#include <gtest/gtest.h>

#include "math/coupled_preconditioner.hpp"
#include "math/krylov.hpp"
#include "math/sparse_ldlt.hpp"
#include "support/allocation_count.hpp"
#include "support/box_matrix.hpp"

namespace muldi::math {
namespace {

TEST(SparseLdlt, RequestsNoMemoryAfterTheFirstTime) {
  test::BoxProblem problem;
  problem.cells = {4, 4, 8};
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  const NodeMask mask = test::box_mask(problem);
  SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  const LdltAnalysis analysis(pattern, mask);
  for (const FactorStorage storage : {FactorStorage::double_precision, FactorStorage::single_precision}) {
    SparseLdlt factor(analysis, storage);
    Eigen::VectorXd x = Eigen::VectorXd::Random(pattern.n_rows());
    Eigen::VectorXd y = x;
    Eigen::MatrixXd many = Eigen::MatrixXd::Random(pattern.n_rows(), 20);
    ASSERT_TRUE(factor.factorise(matrix).ok);
    factor.solve(x);
    factor.solve_columns(many);
    const long before = test::n_allocations();
    matrix.constrain(mask);
    matrix.multiply(x, y);
    ASSERT_TRUE(factor.factorise(matrix).ok);
    factor.solve(x);
    factor.solve_columns(many);
    EXPECT_EQ(test::n_allocations(), before);
  }
}

TEST(IterativeSolvers, RequestNoMemoryAfterTheFirstSolve) {
  test::BoxProblem problem;
  problem.cells = {8, 8, 8};
  problem.mass = 200.0;
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  matrix.constrain(test::box_mask(problem));
  CoupledPreconditioner preconditioner(pattern);
  const auto a = [&](const Eigen::VectorXd& u, Eigen::VectorXd& v) { matrix.multiply(u, v); };
  const auto p = [&](const Eigen::VectorXd& u, Eigen::VectorXd& v) { preconditioner.apply(u, v); };
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(pattern.n_rows());
  Eigen::VectorXd x = b;
  Minres minres;
  FlexibleGmres gmres;
  long before = 0;
  for (int repeat = 0; repeat < 2; ++repeat) {
    before = test::n_allocations();
    ASSERT_TRUE(preconditioner.update(matrix));
    x.setZero();
    ASSERT_TRUE(minres.solve(a, p, b, x).converged());
    x.setZero();
    ASSERT_TRUE(gmres.solve(a, p, b, x).converged());
  }
  EXPECT_EQ(test::n_allocations(), before);
}

}  // namespace
}  // namespace muldi::math
