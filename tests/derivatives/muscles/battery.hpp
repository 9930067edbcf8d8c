#pragma once
/// Examples of every two-point element of the registry and random states, for the battery that each must pass.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <random>
#include <type_traits>
#include <vector>

#include "muscles/registry.hpp"
#include "muscles/two_point_term.hpp"
#include "support/plausible.hpp"
#include "support/types_of.hpp"

namespace muldi::test {

inline constexpr double eps0 = 8.8542e-12;

/// The elements of a list that are on the fast path.
template <class... Found>
base::TypeList<Found...> axial_among(base::TypeList<>, base::TypeList<Found...> found) {
  return found;
}
template <class First, class... Rest, class... Found>
auto axial_among(base::TypeList<First, Rest...>, base::TypeList<Found...> found) {
  if constexpr (muscles::AxialElement<First>) {
    return axial_among(base::TypeList<Rest...>{}, base::TypeList<Found..., First>{});
  } else {
    return axial_among(base::TypeList<Rest...>{}, found);
  }
}
using AxialTypes = decltype(axial_among(muscles::TwoPointTypes{}, base::TypeList<>{}));

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

/// What a scene gives to the silicone muscle.
inline muscles::MuscleGiven silicone_given() {
  return {.section = {muscles::RoundSection{10.0}},
          .length = 100.0,
          .layer_thickness = 0.01,
          .density = 1e-3,
          .shear_modulus = 0.7 / 3.0,
          .viscosity = 10.0,
          .electric_law = muscles::ElectricLaw::ideal(3.7, eps0),
          .eps0 = eps0};
}

/// Elements worth testing beside those that scenes make.
template <class Element>
std::vector<Element> hand_picked() {
  return {};
}
template <>
inline std::vector<muscles::LumpedDea> hand_picked() {
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
inline std::vector<muscles::Spring> hand_picked() {
  return {{.stiffness = 2.0, .rest_length = 80.0, .damping = 0.3}, {.stiffness = 1.5}};
}

/// Examples of one element type: made by the components of the registry from their described fields, and hand-picked.
template <class Element>
std::vector<Element> examples() {
  std::vector<Element> list = hand_picked<Element>();
  for (unsigned seed = 0; seed < 8; ++seed) {
    base::for_each_type(muscles::MuscleModels{}, [&]<class Model>(std::type_identity<Model>) {
      if constexpr (std::is_same_v<muscles::MuscleElement<Model>, Element>) {
        list.push_back(plausible<Model>(seed).element(silicone_given()));
      }
    });
    base::for_each_type(muscles::SpringTypes{}, [&]<class Type>(std::type_identity<Type>) {
      if constexpr (std::is_same_v<muscles::SpringElement<Type>, Element>) {
        list.push_back(plausible<Type>(seed).element(100.0));
      }
    });
  }
  return list;
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
