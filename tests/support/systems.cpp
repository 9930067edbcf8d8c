#include "support/systems.hpp"

#include <Eigen/Geometry>
#include <numbers>

#include "math/rotation.hpp"
#include "multibody/registry.hpp"
#include "muscles/section.hpp"

namespace muldi::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using multibody::ground;
using multibody::Pose;
using multibody::Revolute;

const Vector3d pendulum_inertia(1e5, 3.17e5, 3.17e5);

/// Material of thesis chapter 7: mu 0.7/3 MPa, rho 1e-3 g/mm^3.
muscles::LumpedDea silicone(const muscles::Section& section, double length, double relative_permittivity,
                            double viscosity) {
  return {.shear_modulus = 0.7 / 3.0,
          .viscosity = viscosity,
          .density = 1e-3,
          .length = length,
          .area = section.area(),
          .shape_factor = section.shape_factor(),
          .electric_law = muscles::ElectricLaw::ideal(relative_permittivity, eps0),
          .inertia = muscles::Inertia::thesis};
}

model::Control field_control(const std::string& name, double field) {
  return {.name = name, .unit = base::dimension::field, .function = field};
}

}  // namespace

RigidSystem revolute_chain(int n, double gravity) {
  RigidSystem system;
  system.gravity = Vector3d(0.0, -gravity, 0.0);
  system.length = 92.0 * n;
  for (int i = 0; i < n; ++i) {
    const int body = system.add_body(40.0, pendulum_inertia, {.position = Vector3d(46.0 + 92.0 * i, 0.0, 0.0)});
    const Vector3d axis = i % 2 == 0 ? Vector3d::UnitZ() : Vector3d::UnitY();
    system.connect(Revolute::pattern, {body - 1, body}, Vector3d(92.0 * i, 0.0, 0.0), math::triad_about(axis));
  }
  return system;
}

RigidSystem pendulum(double gravity) { return revolute_chain(1, gravity); }

RigidSystem double_pendulum(double gravity) {
  RigidSystem system = pendulum(gravity);
  system.length = 184.0;
  const int body = system.add_body(40.0, pendulum_inertia, {.position = Vector3d(138.0, 0.0, 0.0)});
  system.connect(Revolute::pattern, {0, body}, Vector3d(92.0, 0.0, 0.0), math::triad_about(Vector3d::UnitZ()));
  return system;
}

RigidSystem muscle_joint(double upper_field, double lower_field) {
  RigidSystem system = pendulum(0.0);
  system.length = 100.0;
  const muscles::LumpedDea muscle = silicone({muscles::RoundSection{11.0}}, 100.0, 3.1, 10.0);
  int control = 0;
  for (const double side : {1.0, -1.0}) {
    system.muscles.push_back({.name = side > 0.0 ? "upper" : "lower",
                              .element = muscle,
                              .a1 = {ground, Vector3d(-10.0, 15.0 * side, 0.0)},
                              .a2 = system.end_at(0, Vector3d(90.0, 15.0 * side, 0.0)),
                              .control = {.control = control++}});
  }
  system.controls = {field_control("upper", upper_field), field_control("lower", lower_field)};
  return system;
}

std::vector<double> odd_fields(double field) {
  std::vector<double> fields(12, 0.0);
  for (std::size_t k = 0; k < 12; k += 2) fields[k] = field;
  return fields;
}

RigidSystem trunk(const std::vector<double>& fields) {
  RigidSystem system;
  system.length = 306.0;
  const muscles::LumpedDea muscle = silicone({muscles::RoundSection{8.0}}, 50.0, 3.7, 100.0);
  const Matrix3d quarter_turn = math::axis_rotation(1, 0.5 * std::numbers::pi);
  for (int i = 0; i < 6; ++i) {
    const Vector3d connector(0.0, 51.0 * i, 0.0);
    const Matrix3d axes = i % 2 == 0 ? Matrix3d(Matrix3d::Identity()) : quarter_turn;
    const int body = system.add_body(61.0, Vector3d(15036.0, 2524.0, 14940.0),
                                     {.position = connector + Vector3d(0.0, 36.958872, 0.0), .orientation = axes});
    system.connect(Revolute::pattern, {body - 1, body}, connector, math::triad_about(axes.col(2)));
    for (const double x : {-7.5, 7.5}) {
      const auto number = static_cast<int>(system.muscles.size());
      system.muscles.push_back({.name = "muscle" + std::to_string(number + 1),
                                .element = muscle,
                                .a1 = system.end_at(body - 1, connector + axes * Vector3d(x, -5.0, 0.0)),
                                .a2 = system.end_at(body, connector + axes * Vector3d(x, 45.0, 0.0)),
                                .control = {.control = number}});
      system.controls.push_back(
          field_control("field" + std::to_string(number + 1), fields[static_cast<std::size_t>(number)]));
    }
  }
  return system;
}

End trunk_tip() { return {5, Vector3d(0.0, 14.041128, 0.0)}; }

RigidSystem heavy_top(double tilt) {
  RigidSystem system;
  system.gravity = Vector3d(0.0, 0.0, -earth_gravity);
  system.length = 50.0;
  const Matrix3d axes = math::axis_rotation(1, tilt);
  // Steiner: 4000 about the tip is 4000 - m l^2 = 1500 about the centre of mass.
  const int body =
      system.add_body(1.0, Vector3d(1500.0, 1500.0, 800.0), {.position = 50.0 * axes.col(2), .orientation = axes});
  system.connect(multibody::Spherical::pattern, {ground, body}, Vector3d::Zero());
  return system;
}

RigidSystem membrane(double field, double viscosity) {
  RigidSystem system;
  system.length = 1.0;
  system.actuators.push_back({.name = "membrane",
                              .element = silicone({muscles::SquareSection{20.0}}, 1.0, 3.7, viscosity),
                              .controls = {muscles::ControlInput{.control = 0}}});
  system.controls = {field_control("field", field)};
  return system;
}

RigidSystem round_actuator(double field, double viscosity) {
  RigidSystem system;
  system.length = 40.0;
  system.actuators.push_back({.name = "round",
                              .element = silicone({muscles::RoundSection{10.0}}, 40.0, 3.7, viscosity),
                              .controls = {muscles::ControlInput{.control = 0}}});
  system.controls = {field_control("field", field)};
  return system;
}

}  // namespace muldi::test
