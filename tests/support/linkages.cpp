#include "support/linkages.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "math/rotation.hpp"
#include "multibody/registry.hpp"

namespace muldi::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using multibody::ground;
using multibody::Revolute;

/// A uniform bar between two points, 0.4 g/mm, x axis along it.
int add_bar(RigidSystem& system, const Vector3d& from, const Vector3d& to) {
  const double length = (to - from).norm();
  const double mass = 0.4 * length;
  const double across = mass * length * length / 12.0;
  Matrix3d axes;
  axes.col(0) = (to - from) / length;
  axes.col(2) = math::triad_about(axes.col(0)).col(0);
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return system.add_body(mass, Vector3d(0.05 * across, across, across),
                         {.position = 0.5 * (from + to), .orientation = axes});
}

/// The corner of the triangle over a b with sides of these lengths, on the left of a to b.
Vector3d corner(const Vector3d& a, const Vector3d& b, double from_a, double from_b) {
  const double base = (b - a).norm();
  const double along = (from_a * from_a - from_b * from_b + base * base) / (2.0 * base);
  const double height = std::sqrt(from_a * from_a - along * along);
  const Vector3d x = (b - a) / base;
  return a + along * x + height * Vector3d::UnitZ().cross(x);
}

// Denavit-Hartenberg of Bennett's linkage: turn theta about z, go `length` along x, twist about x; lengths a, b, a, b
// and twists alpha, beta with sin(alpha)/a = sin(beta)/b.
constexpr double bennett_a = 60.0;
constexpr double bennett_b = 100.0;
constexpr double bennett_alpha = 0.5;
const double bennett_beta = std::asin(bennett_b * std::sin(bennett_alpha) / bennett_a);

/// tan(theta_1/2) tan(theta_2/2) = sin((beta + alpha)/2)/sin((beta - alpha)/2), theta_3 = -theta_1, theta_4 = -theta_2.
std::array<double, 4> bennett_angles(double first) {
  const double product =
      std::sin(0.5 * (bennett_beta + bennett_alpha)) / std::sin(0.5 * (bennett_beta - bennett_alpha));
  const double second = 2.0 * std::atan(product / std::tan(0.5 * first));
  return {first, second, -first, -second};
}

}  // namespace

RigidSystem four_bar(const FourBar& form, double gravity) {
  RigidSystem system;
  system.gravity = Vector3d(0.0, -gravity, 0.0);
  system.length = form.ground;
  const Vector3d a = Vector3d::Zero();
  const Vector3d b(form.ground, 0.0, 0.0);
  const Vector3d tip = form.crank * Vector3d(std::cos(form.crank_angle), std::sin(form.crank_angle), 0.0);
  const Vector3d top = corner(tip, b, form.coupler, form.rocker);
  const int crank = add_bar(system, a, tip);
  const int coupler = add_bar(system, tip, top);
  const int rocker = add_bar(system, top, b);
  system.connect(Revolute::pattern, {ground, crank}, a);
  system.connect(Revolute::pattern, {crank, coupler}, tip);
  system.connect(Revolute::pattern, {coupler, rocker}, top);
  system.connect(Revolute::pattern, {rocker, ground}, b);
  return system;
}

RigidSystem slider_crank(double gravity) {
  RigidSystem system;
  system.gravity = Vector3d(0.0, -gravity, 0.0);
  system.length = 130.0;
  const Vector3d tip = 30.0 * Vector3d(std::cos(0.8), std::sin(0.8), 0.0);
  const Vector3d pin(tip.x() + std::sqrt(100.0 * 100.0 - tip.y() * tip.y()), 0.0, 0.0);
  const int crank = add_bar(system, Vector3d::Zero(), tip);
  const int rod = add_bar(system, tip, pin);
  const int slider = system.add_body(20.0, Vector3d(800.0, 900.0, 1000.0), {.position = pin});
  system.connect(Revolute::pattern, {ground, crank}, Vector3d::Zero());
  system.connect(Revolute::pattern, {crank, rod}, tip);
  system.connect(Revolute::pattern, {rod, slider}, pin);
  system.connect(multibody::Prismatic::pattern, {ground, slider}, pin, math::triad_about(Vector3d::UnitX()));
  return system;
}

RigidSystem quick_return(double gravity) {
  RigidSystem system;
  system.gravity = Vector3d(0.0, -gravity, 0.0);
  system.length = 100.0;
  const Vector3d pivot(0.0, -60.0, 0.0);
  const Vector3d tip = 30.0 * Vector3d(std::cos(0.8), std::sin(0.8), 0.0);
  const Vector3d along = (tip - pivot).normalized();
  const int frame = system.add_body(500.0, Vector3d(1e5, 1e5, 1e5), {.position = 0.5 * pivot});
  const int crank = add_bar(system, Vector3d::Zero(), tip);
  const int block = system.add_body(10.0, Vector3d(800.0, 900.0, 1000.0), {.position = tip});
  const int rocker = add_bar(system, pivot, pivot + 100.0 * along);
  system.connect(multibody::Fixed::pattern, {ground, frame}, Vector3d::Zero());
  system.connect(Revolute::pattern, {frame, crank}, Vector3d::Zero());
  system.connect(Revolute::pattern, {crank, block}, tip);
  system.connect(Revolute::pattern, {frame, rocker}, pivot);
  system.connect(multibody::Prismatic::pattern, {rocker, block}, tip, math::triad_about(along));
  return system;
}

RigidSystem bennett(double first_angle) {
  RigidSystem system;
  system.length = 100.0;
  const std::array<double, 4> angles = bennett_angles(first_angle);
  std::array<Vector3d, 5> points;
  std::array<Vector3d, 5> axes;
  Matrix3d R = Matrix3d::Identity();
  points[0].setZero();
  axes[0] = R.col(2);
  for (std::size_t k = 0; k < 4; ++k) {
    R = R * math::axis_rotation(2, angles[k]);
    points[k + 1] = points[k] + (k % 2 == 0 ? bennett_a : bennett_b) * R.col(0);
    R = R * math::axis_rotation(0, k % 2 == 0 ? bennett_alpha : bennett_beta);
    axes[k + 1] = R.col(2);
  }
  // Ground is the link from points[0] to points[1].
  std::array<int, 3> links{};
  for (std::size_t k = 0; k < 3; ++k) links[k] = add_bar(system, points[k + 1], points[k + 2]);
  system.connect(Revolute::pattern, {ground, links[0]}, points[1], math::triad_about(axes[1]));
  system.connect(Revolute::pattern, {links[0], links[1]}, points[2], math::triad_about(axes[2]));
  system.connect(Revolute::pattern, {links[1], links[2]}, points[3], math::triad_about(axes[3]));
  system.connect(Revolute::pattern, {links[2], ground}, points[4], math::triad_about(axes[4]));
  return system;
}

Eigen::VectorXd bennett_coordinates(const multibody::TreeManifold& manifold, double scene_angle, double first_angle) {
  const std::array<double, 4> in_scene = bennett_angles(scene_angle);
  const std::array<double, 4> now = bennett_angles(first_angle);
  Eigen::VectorXd x = manifold.reference();
  for (const multibody::TreeLink& link : manifold.tree().links) {
    const auto k = static_cast<std::size_t>((link.joint + 1) % 4);  // ground is the link after the first turn
    x[link.first_coordinate] = now[k] - in_scene[k];
  }
  return x;
}

Eigen::VectorXd admissible_rates(const model::Model& model, int body, double rate) {
  return admissible_rates(model, model.manifold->reference(), body, rate);
}

Eigen::VectorXd admissible_rates(const model::Model& model, const Eigen::VectorXd& x, int body, double rate) {
  const multibody::TreeManifold& manifold = manifold_of(model);
  const auto frame = manifold.make_frame();
  manifold.update(x, configuration_at(manifold, x), *frame);
  manifold.choose_loop_rows(*frame);
  Eigen::MatrixXd B(manifold.n_c(), manifold.n_v());
  manifold.project_constraints(*frame, manifold.loop_basis(*frame), B);
  const Eigen::VectorXd w = B.fullPivLu().kernel().col(0);
  return rate / w[manifold.tree().link_of(body).first_rate] * w;
}

}  // namespace muldi::test
