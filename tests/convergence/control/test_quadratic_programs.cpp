/// Objectives on a linear system: the optimum is that of a dense quadratic program, set up here from the discrete
/// equations m (x_1 - x_0)/h = h/2 u_0, m (x_{n+1} - 2 x_n + x_{n-1})/h = h/2 (u_{n-1} + u_n).
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "support/control_problems.hpp"

namespace muldi::control {
namespace {

using test::ControlCase;

constexpr int N = 12;
constexpr double h = 0.1;
constexpr double mass = 2.0;

/// x_n = X.row(n) u; the momentum at the end is momentum . u.
struct LinearMotion {
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(N + 1, N);
  Eigen::RowVectorXd momentum;

  LinearMotion() {
    X(1, 0) = 0.5 * h * h / mass;
    for (int n = 1; n < N; ++n) {
      X.row(n + 1) = 2.0 * X.row(n) - X.row(n - 1);
      X(n + 1, n - 1) += 0.5 * h * h / mass;
      X(n + 1, n) += 0.5 * h * h / mass;
    }
    momentum = mass / h * (X.row(N) - X.row(N - 1));
    momentum[N - 1] += 0.5 * h;
  }
};

/// sum of weight (row . u - wanted)^2.
struct Squares {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(N, N);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(N);
  double constant = 0.0;

  void add(double weight, const Eigen::RowVectorXd& row, double wanted) {
    H += weight * row.transpose() * row;
    g += weight * wanted * row.transpose();
    constant += weight * wanted * wanted;
  }
  Eigen::VectorXd least() const { return H.ldlt().solve(g); }
  double value(const Eigen::VectorXd& u) const { return u.dot(H * u) - 2.0 * g.dot(u) + constant; }
};

TEST(DoubleIntegrator, WeightedObjectivesHaveTheOptimumOfTheirQuadraticProgram) {
  ControlCase at(test::slider());
  at.set_horizon(N, h);
  at.problem.controls = {{.control = 0, .lower = -1e3, .upper = 1e3, .reference = 2.0}};
  at.start_at_rest();
  at.problem.final.momentum.kind = MomentumCondition::Kind::free;
  const model::LinearPoint centre = multibody::body_point(0, Eigen::Vector3d::Zero());
  const std::vector<WeightedObjective> objectives{
      {0.01, Effort{.factors = {1.3}}},
      {0.02, Rate{}},
      {40.0, Tracking{.coordinates = {{.rate = 0, .wanted = 0.3}}}},
      {7.0, Terminal{.points = {{.point = centre, .wanted = {0.5, std::nullopt, std::nullopt}}}}},
      {0.6, KineticEnergy{}}};
  const SolveResult result = solve(at.problem, objectives, resting_guess(at.problem, h), {.tolerance = 1e-10});
  ASSERT_EQ(result.status, SolveStatus::optimal) << result.sentence;

  const LinearMotion motion;
  Squares squares;
  for (int n = 0; n < N; ++n) {
    const Eigen::RowVectorXd unit = Eigen::RowVectorXd::Unit(N, n);
    squares.add(0.01 * 1.3, unit, 0.0);
    // Changes of u over its reference; tracking by the trapezoidal rule, whose first value is fixed.
    if (n > 0) squares.add(0.02 / 4.0, unit - Eigen::RowVectorXd::Unit(N, n - 1), 0.0);
    squares.add(40.0 * h * (n + 1 == N ? 0.5 : 1.0), motion.X.row(n + 1), 0.3);
  }
  squares.add(7.0, motion.X.row(N), 0.5);
  squares.add(0.6 * 0.5 / mass, motion.momentum, 0.0);
  const Eigen::VectorXd u = squares.least();
  EXPECT_NEAR(result.objective, squares.value(u), 1e-9 * squares.value(u));
  for (int n = 0; n < N; ++n) {
    EXPECT_NEAR(result.trajectory.u[static_cast<std::size_t>(n)][0], u[n], 1e-6 * u.lpNorm<Eigen::Infinity>()) << n;
  }
}

}  // namespace
}  // namespace muldi::control
