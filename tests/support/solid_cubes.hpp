#pragma once
/// What tests of solids in a unit cube share: its walls and faces, and its material between electrodes.
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "support/solid_system.hpp"

namespace muldi::test {

/// Shear modulus of the published cubes, MPa.
inline constexpr double cube_mu = 0.233;

/// Nodes on any side of the unit cube.
inline bool on_wall(const Eigen::Vector3d& X) { return X.minCoeff() < 1e-9 || X.maxCoeff() > 1.0 - 1e-9; }

/// The upper end of the unit cube but for a strip of a fifth: an electrode with an edge.
inline bool on_electrode_with_edge(const Eigen::Vector3d& X) { return X[2] > 1.0 - 1e-9 && X[0] < 0.8; }

/// Outer faces of a box mesh in a plane X_component = value, counterclockwise from outside.
inline std::vector<std::array<int, 4>> faces_in(const SolidSystem& system, int component, double value) {
  constexpr std::array<std::array<int, 4>, 6> faces = {
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 4, 7, 3}, {1, 2, 6, 5}}};
  std::vector<std::array<int, 4>> found;
  for (const auto& cell : system.solid.cells) {
    for (const auto& face : faces) {
      std::array<int, 4> nodes{};
      bool all = true;
      for (std::size_t a = 0; a < 4; ++a) {
        nodes[a] = cell[static_cast<std::size_t>(face[a])];
        all = all && std::abs(system.node(nodes[a])[component] - value) < 1e-9;
      }
      if (all) found.push_back(nodes);
    }
  }
  return found;
}

/// Rubber that is dielectric and viscous; `viscosity` in MPa ms.
inline fem::Material viscous_dielectric(fem::Formulation formulation, double lambda, double viscosity) {
  fem::Material material = rubber(cube_mu, lambda, formulation);
  material.electric = fem::IdealDielectric{.permittivity = 3.7 * eps0_si};
  material.viscous = fem::KelvinVoigt{.viscosity = viscosity};
  return material;
}

/// A unit cube of 2^3 distorted cells with the potential 0 below and `voltage` on the electrode; without material yet.
inline SolidSystem charged_cube(const Where& electrode, double voltage) {
  SolidSystem system = solid_of(cube_of(2));
  system.set_potential(plane(2, 0.0), {});
  system.set_potential(electrode, {.constant = voltage});
  return system;
}

}  // namespace muldi::test
