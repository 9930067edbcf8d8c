#pragma once
/// Examples of every two-point element and random states: the battery that each element of the registry must pass.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "muscles/registry.hpp"
#include "muscles/two_point.hpp"

namespace muldi::test {

inline constexpr double eps0 = 8.8542e-12;

/// A list of types as GoogleTest takes it.
template <class List>
struct TypesOf;
template <class... Types>
struct TypesOf<base::TypeList<Types...>> {
  using type = testing::Types<Types...>;
};

/// Examples of one element type; a new element of the registry needs a specialisation.
template <class Element>
std::vector<Element> examples();

/// Silicone muscle of the revolute joint: Z = 100 mm, d = 10 mm.
inline muscles::LumpedDea silicone_muscle() {
  const muscles::Section section{muscles::RoundSection{10.0}};
  return {.shear_modulus = 0.7 / 3.0,
          .viscosity = 10.0,
          .density = 1e-3,
          .length = 100.0,
          .area = section.area(),
          .shape_factor = section.shape_factor(),
          .electric_law = muscles::ElectricLaw::ideal(3.7, eps0)};
}

template <>
inline std::vector<muscles::LumpedDea> examples() {
  std::vector<muscles::LumpedDea> list;
  for (const muscles::Inertia inertia : {muscles::Inertia::consistent, muscles::Inertia::thesis}) {
    for (const muscles::ElectricLaw& law :
         {muscles::ElectricLaw::ideal(3.7, eps0),
          // Wissler's fit of numerics 3.3: c_i = -eps0 cb1/2, -eps0 cb2/2, eps0 cb3/2.
          muscles::ElectricLaw::invariants(-0.41423 * eps0, -1.42679 * eps0, 0.99e-3 * eps0, eps0),
          muscles::ElectricLaw::vu(5e-8, 1e-9, eps0)}) {
      muscles::LumpedDea muscle = silicone_muscle();
      muscle.electric_law = law;
      muscle.inertia = inertia;
      list.push_back(muscle);
    }
  }
  return list;
}

template <>
inline std::vector<muscles::Spring> examples() {
  return {{.stiffness = 2.0, .rest_length = 80.0, .damping = 0.3}, {.stiffness = 1.5}};
}

inline Eigen::Vector3d random_vector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> in(-size, size);
  return {in(random), in(random), in(random)};
}

inline Eigen::Matrix3d random_rotation(std::mt19937& random) {
  Eigen::Quaterniond quaternion;
  quaternion.coeffs() << random_vector(random, 1.0), 0.7;
  return quaternion.normalized().toRotationMatrix();
}

/// A length of 70 to 120 in any direction, velocities up to 1, controls (fields) of 10 to 40 thousand.
template <int n_controls>
muscles::TwoPoint<double, n_controls> random_state(std::mt19937& random) {
  std::uniform_real_distribution<double> length(70.0, 120.0);
  std::uniform_real_distribution<double> control(1e4, 4e4);
  muscles::TwoPoint<double, n_controls> x;
  x.a1 = random_vector(random, 50.0);
  x.a2 = x.a1 + length(random) * random_vector(random, 1.0).normalized();
  x.v1 = random_vector(random, 1.0);
  x.v2 = random_vector(random, 1.0);
  for (double& e : x.e) e = control(random);
  return x;
}

}  // namespace muldi::test
