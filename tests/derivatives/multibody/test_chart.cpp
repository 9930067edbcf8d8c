/// The chart of minimal coordinates: its configuration against the manifold's, its derivatives against differences.
#include <gtest/gtest.h>

#include "math/derivative_check.hpp"
#include "support/linkages.hpp"
#include "support/random_tree.hpp"

namespace muldi::multibody {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Case {
  test::RigidSystem system;
  std::unique_ptr<model::Model> model;
  std::unique_ptr<model::Chart> chart;
  VectorXd theta;
  VectorXd mu;
  VectorXd step;

  Case(std::mt19937& random, test::RigidSystem given) : system(std::move(given)), model(test::make_model(system)) {
    const model::Manifold& manifold = *model->manifold;
    chart = manifold.make_chart();
    chart->set_reference(test::random_coordinates(random, manifold));
    theta = test::random_entries(random, manifold.n_v(), 1.5);
    mu = test::random_entries(random, manifold.n_v(), 1.0);
    step = VectorXd::Constant(manifold.n_v(), 0.02);
  }
};

void expect_derivatives(Case& at) {
  model::ChartPoint point;
  at.chart->evaluate_along(at.theta, at.mu, point);
  model::ChartPoint plain;
  at.chart->evaluate(at.theta, plain);
  EXPECT_LT((plain.q - point.q).norm() + (plain.D - point.D).norm(), 1e-10 * (1.0 + point.q.norm()));
  VectorXd x;
  at.chart->stored(at.theta, x);
  EXPECT_LT((test::configuration_at(*at.model->manifold, x) - point.q).lpNorm<Eigen::Infinity>(), 1e-10);
  VectorXd back;
  at.chart->coordinates(x, back);
  EXPECT_LT((back - at.theta).lpNorm<Eigen::Infinity>(), 1e-12);

  const auto q_of = [&](const VectorXd& theta) {
    model::ChartPoint other;
    at.chart->evaluate(theta, other);
    return other.q;
  };
  const auto a_of = [&](const VectorXd& theta) {
    model::ChartPoint other;
    at.chart->evaluate_along(theta, at.mu, other);
    return other.a;
  };
  EXPECT_LT(math::derivative_error(point.D, math::difference_jacobian(q_of, at.theta, at.step)).relative, 1e-10);
  EXPECT_LT(math::derivative_error(point.A, math::difference_jacobian(a_of, at.theta, at.step)).relative, 1e-10);
  EXPECT_LT((point.D * at.mu - point.a).norm(), 1e-12 * point.a.norm());
}

void expect_curvature(Case& at, std::mt19937& random) {
  const int n_v = at.model->manifold->n_v();
  const VectorXd y = test::random_entries(random, at.model->n_q(), 1.0);
  const VectorXd b = test::random_entries(random, at.model->n_q(), 1.0);
  const auto gradient = [&](const VectorXd& theta) {
    model::ChartPoint other;
    at.chart->evaluate_along(theta, at.mu, other);
    return VectorXd(other.D.transpose() * y + other.A.transpose() * b);
  };
  const MatrixXd expected = math::difference_jacobian(gradient, at.theta, at.step);
  model::ChartPoint point;
  at.chart->evaluate_along(at.theta, at.mu, point);
  MatrixXd H = MatrixXd::Zero(n_v, n_v);
  at.chart->add_curvature_along(y, b, H);
  EXPECT_LT(math::derivative_error(H, expected).relative, 1e-9);

  const auto gradient_of_y = [&](const VectorXd& theta) {
    model::ChartPoint other;
    at.chart->evaluate(theta, other);
    return VectorXd(other.D.transpose() * y);
  };
  const MatrixXd expected_of_y = math::difference_jacobian(gradient_of_y, at.theta, at.step);
  at.chart->evaluate(at.theta, point);
  H.setZero();
  at.chart->add_curvature(y, H);
  EXPECT_LT(math::derivative_error(H, expected_of_y).relative, 1e-9);
}

TEST(TreeChart, DerivativesOfEveryJointTypeAndDirection) {
  std::mt19937 random(1);
  for (const JointPattern& pattern : test::joint_patterns()) {
    for (const auto& ends : {std::pair(0, 1), std::pair(1, 0)}) {
      test::RigidSystem system;
      for (int i = 0; i < 2; ++i) system.add_body(1.0, Eigen::Vector3d::Ones(), test::random_pose(random, 2.0));
      system.connect(pattern, ends, test::random_vector(random, 2.0), test::random_rotation(random));
      Case at(random, system);
      expect_derivatives(at);
      expect_curvature(at, random);
    }
  }
}

TEST(TreeChart, DerivativesOfRandomForests) {
  std::mt19937 random(2);
  for (int i = 0; i < 10; ++i) {
    Case at(random, test::random_forest(random, {.n_bodies = 5, .n_chains = 2, .with_fixed_joints = i % 2 == 0}));
    expect_derivatives(at);
    expect_curvature(at, random);
  }
}

TEST(TreeChart, PlainUnknownsAreTheirOwnCoordinates) {
  std::mt19937 random(3);
  test::RigidSystem system = test::random_forest(random, {.n_bodies = 2, .n_chains = 1});
  system.actuators.push_back({.name = "free", .element = {.shear_modulus = 1.0, .length = 20.0, .area = 1.0}});
  Case at(random, system);
  expect_derivatives(at);
  expect_curvature(at, random);
}

}  // namespace
}  // namespace muldi::multibody
