#pragma once
/// Examples of every material law and random points: the battery that each law of the registry must pass.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "fem/kernel/lanes.hpp"
#include "fem/material.hpp"
#include "support/types_of.hpp"

namespace muldi::test {

inline constexpr double vacuum = 8.8542e-12;

/// Examples of one law; a new law of the registry needs a specialisation.
template <class Law>
std::vector<Law> examples();
template <>
inline std::vector<fem::NeoHookean> examples() {
  return {{.mu = 0.233}};
}
template <>
inline std::vector<fem::BonetWood> examples() {
  return {{.mu = 0.233, .lambda = 10.0}, {.mu = 0.5, .lambda = 0.0}};
}
template <>
inline std::vector<fem::MooneyRivlin> examples() {
  return {{.mu_1 = 0.2, .mu_2 = 0.05}, {.mu_1 = 0.0, .mu_2 = 0.3}};
}
template <>
inline std::vector<fem::Gent> examples() {
  return {{.mu = 0.233, .J_m = 20.0}, {.mu = 0.233, .J_m = 3.0}};
}
template <>
inline std::vector<fem::Quadratic> examples() {
  return {{.kappa = 10.0}};
}
template <>
inline std::vector<fem::Logarithmic> examples() {
  return {{.kappa = 10.0}};
}
template <>
inline std::vector<fem::IdealDielectric> examples() {
  return {{.permittivity = 3.7 * vacuum}};
}
template <>
inline std::vector<fem::Vu> examples() {
  return {{.c1 = 5e-8, .c2 = 1e-9, .eps0 = vacuum}, {.c1 = -1e-11, .c2 = -2e-11, .eps0 = vacuum}};
}
template <>
inline std::vector<fem::Invariants> examples() {
  // Wissler's fit (numerics 3.3), and coefficients of one size.
  return {{.c1 = -0.41423 * vacuum, .c2 = -1.42679 * vacuum, .c3 = 0.99e-3 * vacuum, .eps0 = vacuum},
          {.c1 = -vacuum, .c2 = 0.7 * vacuum, .c3 = -0.5 * vacuum, .eps0 = vacuum}};
}

/// F = 1 + up to 0.2 in each entry, E up to 3e4, rates up to 1.
inline fem::Point<double> random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> in(-1.0, 1.0);
  fem::Point<double> at;
  for (int i = 0; i < 3; ++i) {
    at.E[i] = 3e4 * in(random);
    for (int k = 0; k < 3; ++k) {
      at.F[i][k] = (i == k ? 1.0 : 0.0) + 0.2 * in(random);
      at.F_rate[i][k] = in(random);
    }
  }
  at.complete();
  return at;
}

/// The undeformed point with the field of `random_point` left out.
inline fem::Point<double> rest() {
  fem::Point<double> at;
  for (int i = 0; i < 3; ++i) at.F[i][i] = 1.0;
  at.complete();
  return at;
}

/// (P by rows, -D): the gradient of the energy by (F, E).
template <class T>
std::vector<T> gradient_of(const fem::Stress<T>& stress) {
  std::vector<T> list;
  for (const auto& row : stress.P)
    for (const T& entry : row) list.push_back(entry);
  for (const T& entry : stress.D) list.push_back(-entry);
  return list;
}

template <class Law, class T>
std::vector<T> gradient(const Law& law, const fem::Point<T>& at) {
  fem::Stress<T> stress{};
  law.add_stress(at, stress);
  return gradient_of(stress);
}

/// The stored halves as the whole matrix (12, 12) by (F, E).
inline Eigen::MatrixXd whole(const fem::Tangent<double>& tangent) {
  Eigen::MatrixXd A(12, 12);
  for (int row = 0; row < 4; ++row) {
    for (int column = row; column < 4; ++column) {
      for (int k = 0; k < 3; ++k) {
        for (int l = row == column ? k : 0; l < 3; ++l) {
          const double entry = tangent.block[fem::Tangent<double>::pair(row, column)][3 * k + l];
          A(3 * row + k, 3 * column + l) = entry;
          A(3 * column + l, 3 * row + k) = entry;
        }
      }
    }
  }
  return A;
}

/// Scales (12) that bring derivatives by F and by E to one size.
inline Eigen::VectorXd sizes() {
  Eigen::VectorXd size = Eigen::VectorXd::Ones(12);
  size.tail(3).setConstant(3e4);
  return size;
}

}  // namespace muldi::test
