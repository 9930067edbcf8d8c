#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "math/krylov.hpp"

namespace muldi::math {
namespace {

Eigen::MatrixXd random_matrix(int n) {
  std::srand(11);
  return Eigen::MatrixXd::Random(n, n);
}

Eigen::MatrixXd definite_matrix(int n) {
  const Eigen::MatrixXd r = random_matrix(n);
  return r * r.transpose() + Eigen::MatrixXd::Identity(n, n);
}

struct Problem {
  Eigen::MatrixXd a;
  Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(a.rows(), -1.0, 2.0);
  Eigen::VectorXd x = Eigen::VectorXd::Constant(a.rows(), 0.3);  // a start that is not zero

  auto product() const {
    return [this](const Eigen::VectorXd& u, Eigen::VectorXd& v) { v.noalias() = a * u; };
  }
  auto jacobi() const {
    return [this](const Eigen::VectorXd& u, Eigen::VectorXd& v) { v = u.cwiseQuotient(a.diagonal().cwiseAbs()); };
  }
  double relative_residual() const { return (b - a * x).norm() / b.norm(); }
};

constexpr auto same = [](const Eigen::VectorXd& u, Eigen::VectorXd& v) { v = u; };

TEST(ConjugateGradients, EndsInAsManyStepsAsEigenvalues) {
  Problem problem{Eigen::MatrixXd(Eigen::VectorXd{{1.0, 1.0, 5.0, 5.0, 9.0, 9.0}}.asDiagonal())};
  ConjugateGradients solver;
  const KrylovOutcome outcome = solver.solve(problem.product(), same, problem.b, problem.x, {1e-13});
  EXPECT_TRUE(outcome.converged());
  EXPECT_EQ(outcome.iterations, 3);
  EXPECT_LT(problem.relative_residual(), 1e-13);
}

TEST(ConjugateGradients, ConvergesWithAPreconditioner) {
  Problem problem{definite_matrix(40)};
  ConjugateGradients solver;
  const KrylovOutcome outcome = solver.solve(problem.product(), problem.jacobi(), problem.b, problem.x, {1e-10});
  EXPECT_TRUE(outcome.converged());
  EXPECT_LT(problem.relative_residual(), 1e-9);
}

TEST(ConjugateGradients, SayThatAMatrixIsIndefinite) {
  Problem problem{Eigen::MatrixXd(Eigen::VectorXd{{1.0, -2.0, 3.0}}.asDiagonal())};
  problem.b = Eigen::VectorXd{{0.0, 1.0, 0.0}};
  problem.x.setZero();
  ConjugateGradients solver;
  EXPECT_EQ(solver.solve(problem.product(), same, problem.b, problem.x).end, KrylovEnd::breakdown);
}

TEST(Minres, SolvesAnIndefiniteProblemWithADefinitePreconditioner) {
  Eigen::MatrixXd a = definite_matrix(40);
  a.bottomRightCorner(10, 10) *= -1.0;
  Problem problem{a};
  Minres solver;
  const KrylovOutcome outcome = solver.solve(problem.product(), problem.jacobi(), problem.b, problem.x, {1e-11});
  EXPECT_TRUE(outcome.converged());
  EXPECT_LE(outcome.iterations, 60);
  EXPECT_LT(problem.relative_residual(), 1e-9);
}

TEST(Minres, SaysThatAPreconditionerIsIndefinite) {
  Problem problem{definite_matrix(5)};
  Minres solver;
  const auto negative = [](const Eigen::VectorXd& u, Eigen::VectorXd& v) { v = -u; };
  EXPECT_EQ(solver.solve(problem.product(), negative, problem.b, problem.x).end, KrylovEnd::breakdown);
}

TEST(FlexibleGmres, SolvesAnUnsymmetricProblemInAsManyStepsAsUnknowns) {
  Problem problem{random_matrix(25)};
  FlexibleGmres solver(25);
  const KrylovOutcome outcome = solver.solve(problem.product(), same, problem.b, problem.x, {1e-11});
  EXPECT_TRUE(outcome.converged());
  EXPECT_LE(outcome.iterations, 25);
  EXPECT_LT(problem.relative_residual(), 1e-10);
}

TEST(FlexibleGmres, ConvergesOverRestartsWithAPreconditionerThatChanges) {
  Problem problem{definite_matrix(40) + 0.5 * random_matrix(40)};
  int calls = 0;
  const auto changing = [&](const Eigen::VectorXd& u, Eigen::VectorXd& v) {
    problem.jacobi()(u, v);
    v *= 1.0 + 0.2 * (++calls % 3);
  };
  FlexibleGmres solver(12);
  const KrylovOutcome outcome = solver.solve(problem.product(), changing, problem.b, problem.x, {1e-9});
  EXPECT_TRUE(outcome.converged());
  EXPECT_GT(outcome.iterations, 12);
  EXPECT_LT(problem.relative_residual(), 1e-8);
}

TEST(FlexibleGmres, EndsWhereASingularProblemHasNoSolution) {
  Problem problem{Eigen::MatrixXd(Eigen::VectorXd{{1.0, 2.0, 0.0}}.asDiagonal())};
  FlexibleGmres solver(5);
  EXPECT_EQ(solver.solve(problem.product(), same, problem.b, problem.x).end, KrylovEnd::breakdown);
}

TEST(Krylov, ReturnsTheStartThatIsTheSolutionAndObeysTheLimit) {
  Problem problem{definite_matrix(30)};
  const Eigen::VectorXd start = problem.a.llt().solve(problem.b);
  ConjugateGradients cg;
  Minres minres;
  FlexibleGmres gmres;
  problem.x = start;
  EXPECT_EQ(cg.solve(problem.product(), same, problem.b, problem.x).iterations, 0);
  EXPECT_EQ(minres.solve(problem.product(), same, problem.b, problem.x).iterations, 0);
  EXPECT_EQ(gmres.solve(problem.product(), same, problem.b, problem.x).iterations, 0);
  EXPECT_EQ(problem.x, start);
  const KrylovLimits three{1e-12, 0.0, 3};
  for (const KrylovOutcome& outcome :
       {cg.solve(problem.product(), same, -problem.b, problem.x, three),
        minres.solve(problem.product(), same, Eigen::VectorXd(2.0 * problem.b), problem.x, three),
        gmres.solve(problem.product(), same, Eigen::VectorXd(-3.0 * problem.b), problem.x, three)}) {
    EXPECT_EQ(outcome.end, KrylovEnd::iteration_limit);
    EXPECT_EQ(outcome.iterations, 3);
  }
}

}  // namespace
}  // namespace muldi::math
