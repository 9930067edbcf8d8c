#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "math/coupled_preconditioner.hpp"
#include "math/krylov.hpp"
#include "support/box_matrix.hpp"

namespace muldi::math {
namespace {

/// Waves cross about five cells in a step: many times slower with Jacobi.
test::BoxProblem dynamic_problem(int n) {
  test::BoxProblem problem;
  problem.cells = {n, n, n};
  problem.bulk_modulus = 1000.0;
  problem.mass = 500.0;
  return problem;
}

struct Solved {
  KrylovOutcome outcome;
  Eigen::VectorXd x;
  double residual = 0.0;
};

/// Solver: 0 conjugate gradients, 1 MINRES, 2 GMRES.
Solved solve(const test::BoxProblem& problem, int solver, int degree = 6) {
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  matrix.constrain(test::box_mask(problem));
  CoupledPreconditioner preconditioner(pattern, {.least = degree, .largest = degree});
  EXPECT_TRUE(preconditioner.update(matrix));
  const PotentialSign sign = solver == 2 ? PotentialSign::of_the_matrix : PotentialSign::positive;
  const auto a = [&](const Eigen::VectorXd& u, Eigen::VectorXd& v) { matrix.multiply(u, v); };
  const auto p = [&](const Eigen::VectorXd& u, Eigen::VectorXd& v) { preconditioner.apply(u, v, sign); };
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(pattern.n_rows(), 0.0, 500.0).array().sin();
  Solved solved{{}, Eigen::VectorXd::Zero(b.size())};
  const KrylovLimits limits{1e-8, 0.0, 200};
  if (solver == 0) solved.outcome = ConjugateGradients().solve(a, p, b, solved.x, limits);
  if (solver == 1) solved.outcome = Minres().solve(a, p, b, solved.x, limits);
  if (solver == 2) solved.outcome = FlexibleGmres().solve(a, p, b, solved.x, limits);
  Eigen::VectorXd r(b.size());
  matrix.multiply(solved.x, r);
  solved.residual = (b - r).norm() / b.norm();
  return solved;
}

TEST(CoupledPreconditioner, SolvesInFewIterationsThatDoNotGrowWithTheMesh) {
  for (const int n : {6, 12, 20}) {
    test::BoxProblem problem = dynamic_problem(n);
    problem.potential_sign = 1.0;
    const Solved cg = solve(problem, 0);
    EXPECT_TRUE(cg.outcome.converged());
    EXPECT_LE(cg.outcome.iterations, 25);
    EXPECT_LT(cg.residual, 1.1e-8);
    problem.potential_sign = -1.0;
    const Solved gmres = solve(problem, 2);
    EXPECT_TRUE(gmres.outcome.converged());
    EXPECT_LE(gmres.outcome.iterations, 25) << "the sign costs nothing";
    EXPECT_LT(gmres.residual, 1.1e-8);
    const Solved minres = solve(problem, 1);
    EXPECT_TRUE(minres.outcome.converged());
    EXPECT_LE(minres.outcome.iterations, 60);
    EXPECT_LT((minres.x - gmres.x).norm(), 1e-5 * gmres.x.norm());
  }
}

TEST(CoupledPreconditioner, ServesASolidWithoutPotential) {
  test::BoxProblem problem = dynamic_problem(10);
  problem.block_size = 3;
  const Solved cg = solve(problem, 0);
  EXPECT_TRUE(cg.outcome.converged());
  EXPECT_LT(cg.residual, 1.1e-8);
}

TEST(CoupledPreconditioner, HasTheSameBitsForAnyNumberOfThreads) {
  const test::BoxProblem problem = dynamic_problem(20);
  const Solved one = solve(problem, 2);
  base::set_threads(2);
  const Solved two = solve(problem, 2);
  base::set_threads(1);
  EXPECT_EQ(one.outcome.iterations, two.outcome.iterations);
  EXPECT_EQ(one.x, two.x);
}

TEST(CoupledPreconditioner, IsSymmetricAndPositive) {
  const test::BoxProblem problem = dynamic_problem(3);
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  matrix.constrain(test::box_mask(problem), 7.0);  // positive in rows of the potential too
  CoupledPreconditioner preconditioner(pattern, {.least = 3, .largest = 3});
  ASSERT_TRUE(preconditioner.update(matrix));
  EXPECT_EQ(preconditioner.potential_sign(), -1.0);
  Eigen::MatrixXd p(pattern.n_rows(), pattern.n_rows());
  Eigen::VectorXd z(pattern.n_rows());
  for (Eigen::Index i = 0; i < p.cols(); ++i) {
    preconditioner.apply(Eigen::VectorXd::Unit(p.rows(), i), z);
    p.col(i) = z;
  }
  EXPECT_LT((p - p.transpose()).norm(), 1e-5 * p.norm()) << "single precision";
  const Eigen::MatrixXd symmetric = 0.5 * (p + p.transpose());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric).eigenvalues().minCoeff(), 0.0);
  EXPECT_FLOAT_EQ(static_cast<float>(p(3, 3)), 1.0F / 7.0F);
}

TEST(CoupledPreconditioner, TakesTheDegreeThatFitsTheSpectrum) {
  const auto degree = [](double mass, BlockChebyshev::Degrees degrees) {
    test::BoxProblem problem = dynamic_problem(8);
    problem.mass = mass;
    const SymmetricBlockPattern pattern = test::box_pattern(problem);
    SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
    matrix.constrain(test::box_mask(problem));
    CoupledPreconditioner preconditioner(pattern, degrees);
    EXPECT_TRUE(preconditioner.update(matrix));
    return preconditioner.displacement().degree();
  };
  // Consistent mass alone, with eigenvalues from 1/8 to 27/8, whose ends the estimate does not quite reach: 5/4
  // sqrt(27) is 6.5.
  EXPECT_EQ(degree(1e6, {.least = 1, .largest = 8}), 6);
  EXPECT_EQ(degree(1e6, {.least = 7, .largest = 8}), 7);
  EXPECT_EQ(degree(1e6, {.least = 1, .largest = 4}), 4);
  EXPECT_EQ(degree(0.0, {.least = 1, .largest = 8}), 8);
  EXPECT_EQ(degree(0.0, {.least = 1, .largest = 5}), 5);
}

TEST(CoupledPreconditioner, SaysThatTheDisplacementPartIsNotDefinite) {
  const test::BoxProblem problem = dynamic_problem(2);
  const SymmetricBlockPattern pattern = test::box_pattern(problem);
  SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  matrix.constrain(test::box_mask(problem));
  matrix.values()[0] = -1.0;
  CoupledPreconditioner preconditioner(pattern);
  EXPECT_FALSE(preconditioner.update(matrix));
}

TEST(AggregationMultigrid, NeedsAsManyCyclesOnEveryMesh) {
  for (const std::array<int, 3>& cells : {std::array<int, 3>{8, 8, 8}, {16, 16, 16}, {32, 32, 32}, {6, 6, 90}}) {
    test::BoxProblem problem;
    problem.cells = cells;
    const SymmetricBlockPattern pattern = test::box_pattern(problem);
    SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
    matrix.constrain(test::box_mask(problem));
    const DoubleCsr laplacian = component_matrix(matrix, 3, -1.0);
    AggregationMultigrid multigrid(laplacian);
    EXPECT_LT(multigrid.operator_complexity(), 1.3);
    const auto a = [&](const Eigen::VectorXd& u, Eigen::VectorXd& v) {
      for (int i = 0; i < laplacian.n_rows; ++i) v(i) = laplacian.row_times(i, u.data());
    };
    Eigen::VectorXf out(laplacian.n_rows);
    const auto p = [&](const Eigen::VectorXd& u, Eigen::VectorXd& v) {
      multigrid.apply(u.cast<float>(), out);
      v = out.cast<double>();
    };
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(laplacian.n_rows, 0.0, 300.0).array().sin();
    Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
    const KrylovOutcome outcome = ConjugateGradients().solve(a, p, b, x, {1e-8, 0.0, 50});
    EXPECT_TRUE(outcome.converged());
    EXPECT_LE(outcome.iterations, 9);
  }
}

TEST(AggregationMultigrid, SolvesSmallAndDiagonalMatricesAtOnce) {
  for (const int n : {5, 1000}) {  // directly, and by smoothing alone
    DoubleCsr diagonal{n, n, {0}, {}, {}};
    for (int i = 0; i < n; ++i) {
      diagonal.columns.push_back(i);
      diagonal.values.push_back(2.0 + i);
      diagonal.start.push_back(i + 1);
    }
    AggregationMultigrid multigrid(diagonal);
    EXPECT_EQ(multigrid.n_levels(), 1);
    Eigen::VectorXf x(n);
    multigrid.apply(Eigen::VectorXf::Constant(n, 2.0F), x);
    for (int i = 0; i < n; ++i) EXPECT_FLOAT_EQ(x(i), 2.0F / (2.0F + static_cast<float>(i)));
  }
}

TEST(AggregationMultigrid, RefusesADiagonalThatIsNotPositive) {
  DoubleCsr zero{1, 1, {0, 1}, {0}, {0.0}};
  EXPECT_THROW(AggregationMultigrid{zero}, base::ContractError);
}

TEST(CsrMatrix, MultipliesAndTransposesLikeDenseMatrices) {
  const auto dense = [](const DoubleCsr& a) {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(a.n_rows, a.n_columns);
    for (int i = 0; i < a.n_rows; ++i) a.for_row(i, [&](int j, double value) { result(i, j) += value; });
    return result;
  };
  const DoubleCsr a{2, 3, {0, 2, 3}, {2, 0, 1}, {1.0, 2.0, 3.0}};
  const DoubleCsr b{3, 2, {0, 1, 3, 4}, {1, 0, 1, 0}, {4.0, 5.0, 6.0, 7.0}};
  EXPECT_EQ(dense(product(a, b)), dense(a) * dense(b));
  EXPECT_EQ(dense(transposed(a)), dense(a).transpose());
  EXPECT_EQ(in_single_precision(a).values, (std::vector<float>{1.0F, 2.0F, 3.0F}));
}

}  // namespace
}  // namespace muldi::math
